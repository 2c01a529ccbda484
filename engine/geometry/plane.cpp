// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/plane.h"

#include "engine/geometry/statistics.h"

#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace gpo {
namespace {

std::vector<int> near_plane(const Eigen::Matrix3Xd& points, const Plane& plane, double threshold) {
  std::vector<int> near;
  for (int j = 0; j < points.cols(); ++j)
    if (std::abs(plane.normal.dot(points.col(j)) + plane.distance) <= threshold) near.push_back(j);
  return near;
}

std::optional<Plane> least_squares_plane(const Eigen::Matrix3Xd& points) {
  const Eigen::Vector3d mean = points.rowwise().mean();
  const Eigen::Matrix3Xd centered = points.colwise() - mean;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(centered * centered.transpose());
  if (!(eigen.eigenvalues()(1) > 1e-12 * eigen.eigenvalues()(2))) return std::nullopt;
  const Eigen::Vector3d normal = eigen.eigenvectors().col(0);
  return facing_origin({normal, -normal.dot(mean)});
}

}  // namespace

Plane facing_origin(const Plane& plane) {
  return plane.distance >= 0 ? plane : Plane{-plane.normal, -plane.distance};
}

Plane plane_in_camera(const Plane& plane_w, const Pose& pose) {
  return {pose.R_wc.transpose() * plane_w.normal, plane_w.distance + plane_w.normal.dot(pose.p_wc)};
}

Eigen::Matrix<double, 3, 2> normal_tangents(const Eigen::Vector3d& normal) {
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = normal.unitOrthogonal();
  tangents.col(1) = normal.cross(tangents.col(0));
  return tangents;
}

std::optional<Eigen::Vector3d> intersect(const Plane& plane_w,
                                         const Pose& pose,
                                         const Eigen::Vector3d& ray_c) {
  // Depth along the ray: m = (-d - n.p_wc) / (n . R_wc x); engine/method.md, eq. 12.
  const Eigen::Vector3d ray_w = pose.R_wc * ray_c;
  const double along = plane_w.normal.dot(ray_w);
  const double depth = (-plane_w.distance - plane_w.normal.dot(pose.p_wc)) / along;
  if (!(depth > 0) || !std::isfinite(depth)) return std::nullopt;
  return pose.p_wc + depth * ray_w;
}

std::optional<Plane> fit_plane(const Eigen::Matrix3Xd& points, std::uint64_t seed) {
  constexpr double kThreshold = 0.02;
  constexpr int kSamples = 500;
  const auto n = static_cast<std::uint64_t>(points.cols());
  if (n < 3) return std::nullopt;
  const Eigen::VectorXd norms = points.colwise().norm();
  const double threshold = kThreshold * median({norms.begin(), norms.end()});
  std::mt19937_64 random(seed);
  std::vector<int> best;
  for (int sample = 0; sample < kSamples; ++sample) {
    const Eigen::Vector3d a = points.col(static_cast<Eigen::Index>(random() % n));
    const Eigen::Vector3d b = points.col(static_cast<Eigen::Index>(random() % n));
    const Eigen::Vector3d c = points.col(static_cast<Eigen::Index>(random() % n));
    const Eigen::Vector3d cross = (b - a).cross(c - a);
    if (!(cross.norm() > 1e-12 * a.squaredNorm())) continue;
    const Eigen::Vector3d normal = cross.normalized();
    std::vector<int> near = near_plane(points, {normal, -normal.dot(a)}, threshold);
    if (near.size() > best.size()) best = std::move(near);
    if (best.size() == n) break;
  }
  if (best.size() < 3) return std::nullopt;
  return least_squares_plane(points(Eigen::all, best));
}

}  // namespace gpo
