// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/smooth_path.h"

#include "engine/geometry/decompositions.h"
#include "engine/geometry/pose.h"

#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr Index kOrder = 3;  // order of the penalized differences: quadratic motion is smooth
constexpr Index kStencil = 5;

/// Returns the weights of the values at `t` in the `order`-th derivative at `at` of the polynomial
/// through them.
VectorXd derivative_weights(const VectorXd& t, double at, Index order) {
  const double unit = t(t.size() - 1) - t(0);
  MatrixXd powers(t.size(), t.size());
  VectorXd right = VectorXd::Zero(t.size());
  for (Index k = 0; k < t.size(); ++k)
    powers.row(k) = ((t.array() - at) / unit).pow(static_cast<double>(k)).matrix().transpose();
  right(order) = order == 2 ? 2 : order == 3 ? 6 : 1;
  return powers.partialPivLu().solve(right) / std::pow(unit, order);
}

/// Returns the matrix that maps values at the times to derivatives there.
MatrixXd differentiation(const VectorXd& t, Index order) {
  const Index n = t.size();
  const Index width = std::min(kStencil, n);
  MatrixXd D = MatrixXd::Zero(n, n);
  for (Index i = 0; i < n; ++i) {
    const Index first = std::clamp(i - width / 2, Index{0}, n - width);
    D.row(i).segment(first, width) =
        derivative_weights(t.segment(first, width), t(i), order).transpose();
  }
  return D;
}

/// Returns the sum of squared third derivatives between the times as a quadratic form.
MatrixXd roughness_of(const VectorXd& t) {
  const Index n = t.size();
  MatrixXd D = MatrixXd::Zero(n - kOrder, n);
  for (Index k = 0; k < n - kOrder; ++k) {
    const VectorXd times = t.segment(k, kOrder + 1);
    D.row(k).segment(k, kOrder + 1) = derivative_weights(times, times.mean(), kOrder).transpose();
  }
  return D.transpose() * D;
}

/// Returns the most likely shrinkage of the values along each eigenvector of the roughness, whose
/// squares are given: their prior variance is proportional to 1 / `roughness`.
VectorXd best_shrinkage(const VectorXd& roughness, const VectorXd& squares, double variance) {
  constexpr int kSteps = 60;
  constexpr double kRatio = 3;
  const Index n = roughness.size();
  const Eigen::ArrayXd rough = roughness.tail(n - kOrder), square = squares.tail(n - kOrder);
  Eigen::ArrayXd all(n - kOrder);
  double best = 0;
  double least = std::numeric_limits<double>::infinity();
  double unit = 1e-6 * variance * roughness(n - 1);
  for (int k = 0; k < kSteps; ++k, unit *= kRatio) {
    all = unit / rough + variance;
    const double minus_log = (all.log() + square / all).sum();
    if (minus_log >= least) continue;
    least = minus_log;
    best = unit;
  }
  VectorXd shrinkage = VectorXd::Ones(n);
  shrinkage.tail(n - kOrder) = best / (best + variance * rough);
  return shrinkage;
}

}  // namespace

PathTimes path_times(const VectorXd& times_s) {
  const Index n = times_s.size();
  PathTimes times{.duration_s = n > 0 ? times_s(n - 1) - times_s(0) : 0};
  if (n <= kOrder + 1) return times;
  times.first = differentiation(times_s, 1);
  times.second = differentiation(times_s, 2);
  auto [roughness, vectors] = symmetric_eigen(roughness_of(times_s));
  times.roughness = std::move(roughness);
  times.vectors = std::move(vectors);
  return times;
}

PathTimes path_times(std::span<const std::int64_t> timestamps_ns) {
  VectorXd times_s(std::ssize(timestamps_ns));
  for (Index i = 0; i < times_s.size(); ++i)
    times_s(i) = 1e-9 * static_cast<double>(timestamps_ns[i] - timestamps_ns[0]);
  return path_times(times_s);
}

Derivatives smooth_derivatives(const PathTimes& times,
                               const MatrixXd& values,
                               const VectorXd& noise) {
  const Index n = values.rows();
  const MatrixXd none = MatrixXd::Zero(n, values.cols());
  if (n < 2) return {none, none, none};
  if (n <= kOrder + 1)
    return {((values.row(n - 1) - values.row(0)) / times.duration_s).replicate(n, 1), none, none};
  const MatrixXd along = times.vectors.transpose() * values;
  const MatrixXd first_along = times.first * times.vectors;
  MatrixXd smooth = values, sigma = none;
  for (Index c = 0; c < values.cols(); ++c) {
    if (!(noise(c) > 0)) continue;
    const double variance = noise(c) * noise(c);
    const VectorXd shrinkage = best_shrinkage(times.roughness, along.col(c).cwiseAbs2(), variance);
    smooth.col(c) = times.vectors * shrinkage.cwiseProduct(along.col(c));
    sigma.col(c) = (variance * (first_along.cwiseAbs2() * shrinkage)).cwiseSqrt();
  }
  return {times.first * smooth, times.second * smooth, sigma};
}

std::vector<Velocity> smooth_velocities(const PathTimes& times,
                                        const PlaneMotion& motion,
                                        const PathNoise& noise) {
  const auto n = std::ssize(motion.tau);
  MatrixXd path(n, 6);
  for (Index i = 0; i < n; ++i) {
    path.row(i) << motion.tau[i].transpose(),
        so3_log(motion.R_wc[0].transpose() * motion.R_wc[i]).transpose();
  }
  VectorXd sigmas(6);
  sigmas << Vector3d::Constant(noise.tau), Vector3d::Constant(noise.rotation_rad);
  const auto [first, second, sigma] = smooth_derivatives(times, path, sigmas);
  std::vector<Velocity> velocities(n);
  for (Index i = 0; i < n; ++i) {
    const Matrix3d J = so3_right_jacobian(path.row(i).tail<3>());
    // The derivative of J is of second order in the rotation's rate.
    velocities[i] = {J * first.row(i).tail<3>().transpose(),
                     J * second.row(i).tail<3>().transpose(),
                     first.row(i).head<3>(),
                     second.row(i).head<3>(),
                     sigma.row(i).tail<3>().norm() / std::sqrt(3.0),
                     sigma.row(i).head<3>().norm() / std::sqrt(3.0)};
  }
  return velocities;
}

}  // namespace gpo
