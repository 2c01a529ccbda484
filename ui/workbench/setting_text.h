// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/settings.h"

#include <string>
#include <vector>

namespace gpo {

/// The keys of `visit_settings`, in its order.
std::vector<std::string> setting_keys();

/// The setting's value as scripts and sessions write it: a number, a choice's key, on, off, or
/// default where it is left to the method. Throws InputError for an unknown key.
std::string setting_text(const Settings& settings, const std::string& key);

/// The settings with another value, given as `setting_text` writes it. Throws InputError that names
/// the key, what was found and what is expected.
Settings with_setting(Settings settings, const std::string& key, const std::string& text);

/// The settings with the default value of one; or of all but start, frames and method.
Settings with_default(const Settings& settings, const std::string& key);
Settings with_defaults(const Settings& settings);

}  // namespace gpo
