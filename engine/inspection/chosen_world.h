// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

#include <optional>
#include <string>

namespace gpo {

struct Inspection;

/// Metric scale from the known distance of two points on planes of the window.
struct MeasuredScale {
  double meters_per_unit = 0;
  /// Standard deviation of its logarithm: by the stated length, 0.5 px for each coordinate of the
  /// points, and the planes and the camera, whose correlations are neglected. nullopt if the result
  /// has no uncertainty.
  std::optional<double> log_sigma = std::nullopt;
  std::string reason = {};  ///< why it is unknown, one line; empty if it is known
};

/// Axes of the user's world: the origin is a point on a plane, z is that plane's normal (towards
/// the camera) or up, and x points towards a second point.
struct ChosenWorld {
  Pose T_world_reference;   ///< [unit of the estimate]
  std::string reason = {};  ///< why it is unknown, one line; empty if it is known
};

/// Returns the scale by `Settings::scale_points`; nullopt if none are given. The initialization is
/// ok.
std::optional<MeasuredScale> measure_scale(const Inspection& inspection);

/// Returns the axes by `Settings::world_points`; nullopt if none are given. The initialization is
/// ok.
std::optional<ChosenWorld> choose_world(const Inspection& inspection);

/// World and unit of exported poses, points and planes.
struct ExportWorld {
  Similarity T_world_reference;  ///< from the estimate's world, whose unit is the plane's distance
  std::string axes = "world = reference camera (x right, y down, z forward)";  ///< for people
  bool meters = false;

  std::string description() const {
    return axes + "; unit = " + (meters ? "meter" : "distance of the plane");
  }
};

/// Returns the chosen world, else that of the reference camera, in meters if `metric` is set or the
/// scale was measured. Throws InputError if a requested scale or world is unknown.
ExportWorld export_world(const Inspection& inspection, bool metric);

/// Throws InputError if points for the scale or the world were given but do not determine them.
void check_chosen(const Inspection& inspection);

}  // namespace gpo
