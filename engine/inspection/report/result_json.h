// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/inspection/settings/settings_table.h"

#include <nlohmann/json.hpp>

namespace gpo {

/// `run --json` of the contract. World = reference camera, gauge d = 1; quaternions x y z w. A
/// failed initialization has null for its plane and poses; an unknown metric is null. `settings`
/// has all of them, `unused_settings` the keys of those that the method or the recording did not
/// use.
nlohmann::ordered_json to_json(const Inspection& inspection);

/// Its settings as they were used: what was left open is what it came to.
Settings settings_used(const Inspection& inspection);

/// A setting's value; null where it is left to the method.
nlohmann::ordered_json value_json(const SettingValue& value);

}  // namespace gpo
