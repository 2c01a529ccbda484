// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/inspection/settings/settings_table.h"

#include <nlohmann/json.hpp>

namespace gpo {

/// Returns the result of `run --json`. World = reference camera, gauge d = 1; quaternions x y z w.
/// Plane and poses are null for a failed initialization, metrics are null if unknown.
/// `unused_settings` has the keys of settings without effect on this method or recording.
nlohmann::ordered_json to_json(const Inspection& inspection);

/// Returns the settings as they were used, with defaults replaced by their values.
Settings settings_used(const Inspection& inspection);

/// Returns a setting's value; null if it is left to the method.
nlohmann::ordered_json value_json(const SettingValue& value);

}  // namespace gpo
