// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

namespace gpo {

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
