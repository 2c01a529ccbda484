// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <optional>
#include <string>

namespace gpo {

/// Name of a plane by its orientation to gravity.
struct PlaneName {
  /// floor: level, below the cameras, and the lowest such plane of the window; table: level, above
  /// the floor; ceiling: level, above the cameras; wall: upright; slanted.
  std::string name;
  double tilt_deg = 0;   ///< angle of its normal (towards the cameras) from up: 0 floor, 90 wall
  double sigma_deg = 0;  ///< uncertainty of the tilt (1 sigma), from the normal and from gravity
};

/// Returns the name of a plane by its number in the window; nullopt if gravity or the plane is
/// unknown or less certain than 15 deg.
std::optional<PlaneName> plane_name(const Inspection& inspection, int number);

/// Returns "plane 2 (wall)", or "plane 2" without a name.
std::string plane_title(const Inspection& inspection, int number);

/// Returns the meters per unit of the estimate; nullopt if the accelerometer does not determine
/// them.
std::optional<double> known_scale(const Inspection& inspection);
/// Returns the same; throws InputError with the reason if it is unknown.
double meters_per_unit(const Inspection& inspection);

}  // namespace gpo
