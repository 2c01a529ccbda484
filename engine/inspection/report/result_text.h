// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <optional>
#include <string>

namespace gpo {

/// Returns the short table that `run` prints, with units.
std::string to_text(const Inspection& inspection);

/// Returns the map points as ASCII PLY with their track's id, as the views draw them. Unit:
/// distance of the plane, or meter.
std::string to_ply(const Inspection& inspection, const std::optional<double>& meters_per_unit = {});

}  // namespace gpo
