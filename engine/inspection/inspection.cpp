// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspection.h"

#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"
#include "engine/pipeline/method_defaults.h"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

double parallax_px(const Window& window, int frame) {
  const Eigen::Matrix3d H_rotation =
      window.K * window.R_wc[frame].transpose() * window.R_wc[0] * window.K.inverse();
  std::vector<double> lengths;
  for (int j = 0; j < window.track_count(); ++j) {
    if (!window.inlier[frame][j]) continue;
    const Eigen::Vector2d rotated =
        (H_rotation * window.points_px[0].col(j).homogeneous()).hnormalized();
    lengths.push_back((window.points_px[frame].col(j) - rotated).norm());
  }
  return lengths.empty() ? std::numeric_limits<double>::quiet_NaN() : median(std::move(lengths));
}

double rotation_rate_deg_s(const Window& window, int from, int to) {
  const Eigen::AngleAxisd rotation(window.R_wc[from].transpose() * window.R_wc[to]);
  const double seconds =
      1e-9 * static_cast<double>(window.timestamps_ns[to] - window.timestamps_ns[from]);
  return rotation.angle() * 180 / M_PI / seconds;
}

/// Returns the center of a base of the default side, from the origin, in units of the anchor. It is
/// the same in both worlds, whatever the plane's distance from the truth's origin.
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

std::vector<FrameMotion> frame_motion(const Window& window) {
  const int count = window.frame_count();
  std::vector<FrameMotion> motion(count);
  for (int i = 0; i < count; ++i) {
    motion[i].parallax_px = parallax_px(window, i);
    const int from = std::min(i, count - 2);
    if (count > 1) motion[i].rotation_rate_deg_s = rotation_rate_deg_s(window, from, from + 1);
  }
  return motion;
}

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

std::string inliers_note(const Inspection& inspection) {
  if (inspection.window->inliers == Inliers::consistent) return "tracks, consistent";
  const InitializeOptions& options = inspection.settings.options;
  const bool requested = uses_ransac(options) && inliers_used(options) == Inliers::consistent;
  return requested ? "tracks, per frame: too few are consistent" : "tracks";
}

}  // namespace gpo
