// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <optional>
#include <string>

namespace gpo {

/// What a plane is to gravity.
struct PlaneName {
  /// floor: level, below the cameras, and the lowest such plane of the window, whatever it is;
  /// table: level, above the floor; ceiling: level, above the cameras; wall: upright; slanted.
  std::string name;
  double tilt_deg = 0;   ///< of its normal (towards the cameras) from up: 0 floor, 90 wall
  double sigma_deg = 0;  ///< of the tilt: that of the normal and of gravity, one standard deviation
};

/// Of a plane by its number in the window; nothing where gravity or the plane is not known, or not
/// well enough (15 deg) to say.
std::optional<PlaneName> plane_name(const Inspection& inspection, int number);

/// "plane 2 (wall)", or "plane 2".
std::string plane_title(const Inspection& inspection, int number);

/// Meters per unit of the estimate by the accelerometer; nothing where it does not tell them.
std::optional<double> known_scale(const Inspection& inspection);
/// The same for who cannot do without. Throws InputError with the reason why it is not known.
double meters_a_unit(const Inspection& inspection);

}  // namespace gpo
