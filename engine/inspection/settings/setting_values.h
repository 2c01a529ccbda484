// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/settings/settings_table.h"

#include <string>

namespace gpo {

/// Returns a value as scripts, sessions and the command line write it: a number, a choice's key,
/// on, off, ids with commas or none, or default if it is left to the method.
std::string value_text(const SettingValue& value);
/// Parses a value. Throws SettingError if it is invalid.
SettingValue value_from(const Setting& setting,
                        const std::string& text,
                        const MethodTable& methods = {});
/// Sets a value; the table resolves a method.
void set_value(Settings& settings,
               const Setting& setting,
               const SettingValue& value,
               const MethodTable& methods = {});

std::string setting_text(const Settings& settings, const std::string& key);
/// Returns the settings with another value. Throws InputError for an unknown key, SettingError for
/// an invalid value.
Settings with_setting(Settings settings,
                      const std::string& key,
                      const std::string& text,
                      const MethodTable& methods = {});

/// Returns the settings with a switch on or off; left to the method if that is its default.
Settings switched(Settings settings, const std::string& key, bool on);

/// Returns the settings with one at its default.
Settings with_default(Settings settings, const std::string& key);

/// Returns whether the method reads a setting; false only for an option that it does not list.
bool is_read(const Setting& setting, const MethodChoice& method);

/// Returns why a setting has no effect with the others or in this recording (null: in any), in one
/// line; empty if it may have one.
std::string why_idle(const Setting& setting, const Settings& settings, const Recording* recording);

/// Returns the settings in a normal form, equal for equal results: values left to the method are
/// replaced by those it uses, values that it does not read by their defaults. Throws InputError for
/// an unknown method.
Settings as_used(Settings settings);

/// Returns the settings on which the results of a stage depend, in normal form; those of later
/// stages, the method among them, are at their defaults.
Settings acting_until(SettingStage stage, const Settings& settings);

}  // namespace gpo
