// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/results/plane_in_view.h"

#include "engine/geometry/plane_fit.h"

#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

constexpr double kNear_deg = 2;
constexpr int kLeastPoints = 10;

/// Directions of the reference frame's inliers, 3 x n, unit.
Eigen::Matrix3Xd inlier_rays(const Window& window) {
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  const std::vector<int> tracks = window.inlier_tracks(0);
  Eigen::Matrix3Xd rays(3, std::ssize(tracks));
  for (Eigen::Index k = 0; k < rays.cols(); ++k)
    rays.col(k) = (K_inverse * window.points_px[0].col(tracks[k]).homogeneous()).normalized();
  return rays;
}

}  // namespace

std::optional<Plane> plane_in_view(const Eigen::Matrix3Xd& points,
                                   const Pose& reference,
                                   const Window& window) {
  const Eigen::Matrix3Xd rays = inlier_rays(window);
  if (rays.cols() == 0) return std::nullopt;
  const double near = std::cos(radians(kNear_deg));
  const Eigen::Vector3d middle = rays.rowwise().sum().normalized();
  const double widest = std::acos(std::min(1.0, (middle.transpose() * rays).minCoeff()));
  const double in_cone = std::cos(std::min(widest + radians(kNear_deg), M_PI));
  Eigen::Matrix3Xd seen(3, points.cols());
  int count = 0;
  for (const auto& point : points.colwise()) {
    const Eigen::Vector3d P = to_camera(reference, point);
    const double distance = P.norm();
    if (!(P.z() > 0) || middle.dot(P) < in_cone * distance) continue;
    if ((P.transpose() * rays).maxCoeff() >= near * distance) seen.col(count++) = P;
  }
  if (count < kLeastPoints) return std::nullopt;
  const auto plane = fit_plane(seen.leftCols(count));
  if (!plane) return std::nullopt;
  return plane_in_camera(*plane, inverse(reference));
}

}  // namespace gpo
