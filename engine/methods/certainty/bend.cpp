// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/bend.h"

#include "engine/geometry/decompositions.h"
#include "engine/methods/certainty/sandwich.h"
#include "engine/methods/plane/plane_weights.h"

#include <algorithm>
#include <map>
#include <vector>

#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Quadratic = Eigen::Matrix<double, 6, 1>;  // 1, a, b, a^2, ab, b^2

constexpr std::size_t kLeastHeights = 12;  // twice the quadratic's numbers
/// Chi-square of three numbers that noise alone exceeds once in 50,000 windows.
constexpr double kLeastBend = 24;

/// A track's height above its plane, from all frames that see it.
struct Height {
  Vector2d place;          ///< over the plane's tangents [distance of the leading plane]
  double gradient = 0;     ///< of the errors, over the logarithm of its distance [px^2]
  double information = 0;  ///< [px^2]
};

std::vector<Height> heights_of(const PlaneObservations& observations,
                               const PlaneMotion& motion,
                               int plane) {
  const Vector3d m = plane == 0 ? motion.normal : motion.others[plane - 1].m;
  const auto tangents = normal_tangents(m.normalized());
  std::map<int, Height> heights;
  for (int i = 1; i < static_cast<int>(motion.tau.size()); ++i) {
    const FrameObservations& f = of_plane(observations, plane)[i];
    const FrameState state = frame_state(observations, motion, i, m);
    for (int k = 0; k < f.count; ++k) {
      const Transfer transfer = transfer_of(f, state, k);
      const Vector2d dp = transfer.d_normal() * m;
      const double weight = f.mask[k] * f.mask[k];
      Height& height = heights[f.track[k]];
      height.place = tangents.transpose() * transfer.ray_1 / -transfer.height;
      height.gradient += weight * dp.dot(transfer.pixel - Vector2d(f.u[k], f.v[k]));
      height.information += weight * dp.squaredNorm();
    }
  }
  std::vector<Height> known;
  for (const auto& [track, height] : heights)
    if (height.information > 0) known.push_back(height);
  return known;
}

}  // namespace

std::optional<Eigen::Matrix2d> bend_of(const PlaneObservations& observations,
                                       const PlaneMotion& motion,
                                       int plane,
                                       double sigma_px) {
  const std::vector<Height> heights = heights_of(observations, motion, plane);
  if (heights.size() < kLeastHeights || !(sigma_px > 0)) return std::nullopt;
  const double distance = plane == 0 ? 1 : 1 / motion.others[plane - 1].m.norm();
  Vector2d mean = Vector2d::Zero();
  for (const Height& one : heights) mean += one.place / static_cast<double>(heights.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
  Quadratic right = Quadratic::Zero();
  double squares = 0;
  for (const Height& one : heights) {
    const Vector2d p = one.place - mean;
    spread += p * p.transpose() / static_cast<double>(heights.size());
    Quadratic q;
    q << 1, p.x(), p.y(), p.x() * p.x(), p.x() * p.y(), p.y() * p.y();
    const double weight = one.information / (sigma_px * sigma_px);
    const double height = -one.gradient / one.information * distance;
    A += weight * q * q.transpose();
    right += weight * q * height;
    squares += weight * height * height;
  }
  const Eigen::MatrixXd inverse = inverse_of_symmetric(A);
  const Quadratic fit = inverse * right;
  if (!fit.allFinite()) return std::nullopt;
  const double freedom = static_cast<double>(heights.size()) - 6;
  const double noise = std::max(1.0, (squares - right.dot(fit)) / freedom);
  const Eigen::Matrix3d covariance = noise * inverse.bottomRightCorner<3, 3>();
  const Vector3d curvature = fit.tail<3>();
  if (!(curvature.dot(covariance.inverse() * curvature) > kLeastBend)) return std::nullopt;
  Eigen::Matrix2d slope;
  slope << 2 * curvature(0), curvature(1), curvature(1), 2 * curvature(2);
  return Eigen::Matrix2d(slope * spread * slope);
}

}  // namespace gpo
