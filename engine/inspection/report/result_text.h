// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <optional>
#include <string>

namespace gpo {

/// The short table that `run` prints, with units.
std::string to_text(const Inspection& inspection);

/// Map points, ASCII PLY with the track's id; the very points that the views draw. Unit: distance
/// of the plane, or the meter.
std::string to_ply(const Inspection& inspection, const std::optional<double>& meters_a_unit = {});

}  // namespace gpo
