// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/plane_result.h"

#include "engine/geometry/statistics.h"
#include "engine/methods/common/map_points.h"
#include "engine/methods/common/window_checks.h"

#include <algorithm>
#include <utility>

namespace gpo {
namespace {

/// The other one of the two solutions with the same pictures.
void turn_normals(SolverReport& solver) {
  for (SolverStep& step : solver.trace) {
    if (step.normal) step.normal = -*step.normal;
  }
}

}  // namespace

Initialization checked_result(const Window& window, Initialization result) {
  result = trusted(window, std::move(result));
  if (!result.ok) return result;
  result.points = lift_to_plane(window, result.plane, result.cameras);
  result.dropped = beyond_horizon(window, result.plane);
  std::erase_if(result.points, [&](const MapPoint& point) {
    return std::ranges::binary_search(result.dropped, point.track);
  });
  result.rms_px = root_mean_square(reprojection_errors_px(window, result.plane, result.cameras));
  return result;
}

Initialization make_result(const Window& window,
                       const PlaneMotion& motion,
                       const SolverReport& solver) {
  const PlaneMotion visible = facing(window, motion);
  Initialization result;
  result.solver = solver;
  if (visible.normal.dot(motion.normal) < 0) turn_normals(result.solver);
  result.plane = {visible.normal, 1};
  result.cameras = cameras_of(visible);
  if (!window.planes.empty()) result.planes.push_back({window.leader, result.plane});
  for (const auto& [number, m] : visible.others)
    result.planes.push_back({number, {m.normalized(), 1 / m.norm()}});
  return checked_result(window, std::move(result));
}

}  // namespace gpo
