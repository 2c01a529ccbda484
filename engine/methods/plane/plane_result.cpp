// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/plane_result.h"

#include "engine/geometry/statistics.h"
#include "engine/methods/common/window_checks.h"

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {

std::vector<MapPoint> lift_to_plane(const Window& window,
                                    const Plane& plane,
                                    std::span<const Pose> cameras) {
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  std::vector<MapPoint> points;
  for (const int j : window.inlier_tracks(0)) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int lifted = 0;
    for (int i = 0; i < std::ssize(cameras); ++i) {
      if (!window.inlier[i][j]) continue;
      const Eigen::Vector3d ray_c = K_inverse * window.points_px[i].col(j).homogeneous();
      if (const auto point = intersect(plane, cameras[i], ray_c)) {
        sum += *point;
        ++lifted;
      }
    }
    if (lifted > 0) points.push_back({j, sum / lifted});
  }
  return points;
}

PlaneMotion motion_of(const Initialization& result) {
  PlaneMotion motion = motion_of(result.plane, result.cameras);
  for (std::size_t k = 1; k < result.planes.size(); ++k) {
    const auto& [normal, distance] = result.planes[k].plane;
    motion.others.push_back({result.planes[k].number, result.plane.distance * normal / distance});
  }
  return motion;
}

Eigen::Matrix3d homography_of(const Window& window, const Pose& pose, const Plane& plane) {
  const Eigen::Vector3d tau = -pose.p_wc / plane.distance;
  return window.K * pose.R_wc.transpose() *
         (Eigen::Matrix3d::Identity() - tau * plane.normal.transpose()) * window.K.inverse();
}

Initialization with_map_points(const Window& window, Initialization result) {
  result = trusted(window, std::move(result));
  if (!result.ok) return result;
  result.points = lift_to_plane(window, result.plane, result.cameras);
  result.dropped = beyond_horizon(window, result.plane);
  std::erase_if(result.points, [&](const MapPoint& point) {
    return std::ranges::binary_search(result.dropped, point.track);
  });
  result.rms_px = root_mean_square(reprojection_errors_px(window, result.plane, result.cameras));
  set_fit_errors(window, result);
  return result;
}

RefusedSolution solution_of(const PlaneMotion& motion) {
  RefusedSolution solution{{motion.normal, 1}, {}};
  for (std::size_t i = 0; i < motion.tau.size(); ++i)
    solution.cameras.push_back({motion.R_wc[i], Eigen::Vector3d::Zero() - motion.tau[i]});  // no -0
  return solution;
}

Initialization make_result(const Window& window,
                           const PlaneMotion& motion,
                           const SolverReport& solver) {
  const PlaneMotion visible = facing(window, motion);
  Initialization result;
  result.solver = solver;
  if (visible.normal.dot(motion.normal) < 0) {
    for (SolverStep& step : result.solver.trace)
      if (step.normal) step.normal = -*step.normal;
  }
  RefusedSolution solution = solution_of(visible);
  result.plane = solution.plane;
  result.cameras = std::move(solution.cameras);
  if (!window.planes.empty()) result.planes.push_back({window.leader, result.plane});
  for (const auto& [number, m] : visible.others)
    result.planes.push_back({number, {m.normalized(), 1 / m.norm()}});
  return with_map_points(window, std::move(result));
}

}  // namespace gpo
