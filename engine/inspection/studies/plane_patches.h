// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Extent of a plane other than the leading one, in the estimate's world.
struct PlanePatch {
  int number = 0;  ///< plane number in the window
  Eigen::Vector3d normal;
  std::array<Eigen::Vector3d, 4> corners;
  std::vector<MapPoint> points;
};

/// Returns the patches of all further planes of a successful initialization.
std::vector<PlanePatch> plane_patches(const Inspection& inspection);

/// Returns the patch of a refused solution's plane; nullopt if none of its tracks meets it.
std::optional<PlanePatch> refused_patch(const Inspection& inspection);

}  // namespace gpo
