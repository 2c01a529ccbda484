// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/commands/completion.h"

#include "engine/geometry/camera_resection.h"
#include "engine/geometry/triangulation.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

/// PnP needs four points; with fewer than these it is a guess.
constexpr int kLeastSeenPoints = 6;

}  // namespace

std::vector<MapPoint> triangulated(const Window& window,
                                   std::span<const std::optional<Pose>> given) {
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  std::vector<MapPoint> points;
  for (int j = 0; j < window.track_count(); ++j) {
    if (!window.inlier[0][j]) continue;
    std::vector<Pose> cameras;
    Eigen::Matrix3Xd rays(3, window.frame_count());
    for (int i = 0; i < window.frame_count(); ++i) {
      if (!given[i] || !window.inlier[i][j]) continue;
      rays.col(std::ssize(cameras)) = K_inverse * window.points_px[i].col(j).homogeneous();
      cameras.push_back(*given[i]);
    }
    if (cameras.size() < 2) continue;
    const auto point = triangulate(cameras, rays.leftCols(std::ssize(cameras)));
    if (point) points.push_back({j, *point});
  }
  return points;
}

std::optional<Pose> resected(const Window& window, const std::vector<MapPoint>& points, int frame) {
  Eigen::Matrix3Xd positions(3, std::ssize(points));
  Eigen::Matrix2Xd pixels(2, std::ssize(points));
  int count = 0;
  for (const MapPoint& point : points) {
    if (!window.points_px[frame].col(point.track).allFinite()) continue;
    positions.col(count) = point.position;
    pixels.col(count++) = window.points_px[frame].col(point.track);
  }
  if (count < kLeastSeenPoints) return std::nullopt;
  const auto found = resect_camera(positions.leftCols(count), pixels.leftCols(count), window.K);
  return found ? std::optional(found->pose) : std::nullopt;
}

}  // namespace gpo
