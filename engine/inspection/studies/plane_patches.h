// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// The part of a plane beside the leading one that its tracks lie on, in the estimate's world.
struct PlanePatch {
  int number = 0;  ///< of the plane in the window
  Eigen::Vector3d normal;
  std::array<Eigen::Vector3d, 4> corners;
  std::vector<MapPoint> points;
};

/// One a further plane of an initialization that is ok.
std::vector<PlanePatch> plane_patches(const Inspection& inspection);

/// Of the plane of a solution that was refused; nothing where none of its tracks meets it.
std::optional<PlanePatch> refused_patch(const Inspection& inspection);

}  // namespace gpo
