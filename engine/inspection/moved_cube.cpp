// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/moved_cube.h"

namespace gpo {
namespace {

/// From the origin to the middle of a base of the default side, in units of the anchor: the same in
/// both worlds, whatever the plane's distance from the truth's origin is.
Eigen::Vector3d middle_of_base(const Inspection& inspection) {
  const CubeAnchor& cube = *inspection.cube;
  if (!cube.on_board) return Eigen::Vector3d::Zero();
  const double side = default_cube_side(cube, inspection.initialization->plane.distance);
  return Eigen::Vector3d(0.5, 0.5, 0) * side / cube.unit;
}

void put(CubeAnchor& cube, const Eigen::Vector3d& place, const Eigen::Vector3d& middle) {
  cube.origin = place - cube.axes * (cube.unit * middle);
}

}  // namespace

void move_cubes(Inspection& inspection, const Eigen::Vector3d& ray_c) {
  if (!inspection.cube) return;
  const auto place = intersect(inspection.initialization->plane, Pose{}, ray_c);
  if (!place) return;
  const Eigen::Vector3d middle = middle_of_base(inspection);
  put(*inspection.cube, *place, middle);
  if (!inspection.true_cube) return;
  const WindowTruth& truth = *inspection.truth;
  if (const auto true_place = intersect(*truth.plane, *truth.cameras.front(), ray_c))
    put(*inspection.true_cube, *true_place, middle);
  else
    inspection.true_cube.reset();
}

}  // namespace gpo
