// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/motion.h"

#include "engine/geometry/statistics.h"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

double parallax_px(const Window& window, int frame) {
  const Eigen::Matrix3d H_rotation =
      window.K * window.R_wc[frame].transpose() * window.R_wc[0] * window.K.inverse();
  std::vector<double> ways;
  for (int j = 0; j < window.track_count(); ++j) {
    if (!window.inlier[frame][j]) continue;
    const Eigen::Vector2d turned =
        (H_rotation * window.points_px[0].col(j).homogeneous()).hnormalized();
    ways.push_back((window.points_px[frame].col(j) - turned).norm());
  }
  return ways.empty() ? std::numeric_limits<double>::quiet_NaN() : median(std::move(ways));
}

double rotation_rate_deg_s(const Window& window, int from, int to) {
  const Eigen::AngleAxisd turn(window.R_wc[from].transpose() * window.R_wc[to]);
  const double seconds =
      1e-9 * static_cast<double>(window.timestamps_ns[to] - window.timestamps_ns[from]);
  return turn.angle() * 180 / M_PI / seconds;
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

}  // namespace gpo
