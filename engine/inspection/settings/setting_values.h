// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/settings/settings_table.h"

#include <string>

namespace gpo {

/// A value as scripts, sessions and the command line write it: a number, a choice's key, on, off,
/// ids with commas or none, or default where it is left to the method.
std::string value_text(const SettingValue& value);
/// Reads it. Throws SettingError that names the setting, what was found and what is expected.
SettingValue value_from(const Setting& setting,
                        const std::string& text,
                        const MethodTable& methods = {});
/// Sets it; a method is found in the table.
void set_value(Settings& settings,
               const Setting& setting,
               const SettingValue& value,
               const MethodTable& methods = {});

std::string setting_text(const Settings& settings, const std::string& key);
/// The settings with another value. Throws InputError for an unknown key, SettingError for a value.
Settings with_setting(Settings settings,
                      const std::string& key,
                      const std::string& text,
                      const MethodTable& methods = {});

/// The settings with a switch on or off; left to the method where that does so by itself.
Settings switched(Settings settings, const std::string& key, bool on);

/// The settings with the default value of one.
Settings with_default(Settings settings, const std::string& key);

/// Whether the method heeds a setting; false only for an option that it does not name.
bool is_read(const Setting& setting, const MethodChoice& method);

/// Why a setting changes nothing beside the others, or in this recording (null: in any), in one
/// line; empty where it may.
std::string why_idle(const Setting& setting, const Settings& settings, const Recording* recording);

/// What is left to the method as it comes to, what the method does not read at its default:
/// settings that come to the same are equal. Throws InputError for an unknown method.
Settings as_used(Settings settings);

/// What the results of a stage depend on: the settings that act before or in it, as the method uses
/// them; all others at their defaults, the method among them.
Settings acting_until(SettingStage stage, const Settings& settings);

}  // namespace gpo
