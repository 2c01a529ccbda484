// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/common/map_points.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {

std::vector<MapPoint> lift_to_plane(const Window& window,
                                    const Plane& plane,
                                    std::span<const Pose> cameras) {
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  std::vector<MapPoint> points;
  for (int j = 0; j < window.track_count(); ++j) {
    if (!window.inlier[0][j]) continue;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int lifted = 0;
    for (int i = 0; i < window.frame_count(); ++i) {
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

}  // namespace gpo
