// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/experiment.h"
#include "engine/experiment/row.h"

#include <span>

#include <nlohmann/json.hpp>

namespace gpo {

/// summary.json: the experiment; on what its times were measured; per configuration and length over
/// all windows; the same for each recording; and for each of the figures over the windows that all
/// of its configurations solved.
nlohmann::ordered_json to_json(const Experiment& experiment, std::span<const Row> rows);

}  // namespace gpo
