// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/smooth_path.h"

#include "engine/geometry/decompositions.h"
#include "engine/geometry/pose.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>
#include <Eigen/SparseCholesky>

namespace gpo {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;
using Banded = Eigen::SimplicialLLT<SparseMatrix>;

constexpr Index kOrder = 3;  // derivative that the smoothing penalizes

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

/// Returns the third differences, the means of the third derivative over four times each, weighted
/// by the quadratic B-splines of `b_spline`.
SparseMatrix third_differences(const VectorXd& t) {
  const Index n = t.size();
  MatrixXd D = MatrixXd::Zero(n - kOrder, n);
  for (Index k = 0; k < n - kOrder; ++k) {
    const VectorXd times = t.segment(k, kOrder + 1);
    D.row(k).segment(k, kOrder + 1) = derivative_weights(times, times.mean(), kOrder).transpose();
  }
  return D.sparseView();
}

double square_after(double t, double u) { return t > u ? (t - u) * (t - u) : 0; }

/// Returns the B-spline over t_k to t_k+3, of integral 1, at time u.
double b_spline(const VectorXd& t, Index k, double u) {
  double sum = 0;
  for (Index j = k; j <= k + kOrder; ++j) {
    double product = 1;
    for (Index l = k; l <= k + kOrder; ++l)
      if (l != j) product *= t(j) - t(l);
    sum += kOrder * square_after(t(j), u) / product;
  }
  return sum;
}

/// Calls `add(u, weight)` for the nodes of Gauss' rule, exact to degree 5, in [t_i, t_i+1].
template <typename Add>
void integrate(const VectorXd& t, Index i, const Add& add) {
  constexpr double kNode = 0.7745966692414834;  // root of 3/5
  const double middle = 0.5 * (t(i) + t(i + 1)), half = 0.5 * (t(i + 1) - t(i));
  add(middle - half * kNode, half * 5 / 9);
  add(middle, half * 8 / 9);
  add(middle + half * kNode, half * 5 / 9);
}

/// Inner products of the B-splines.
SparseMatrix gram_matrix(const VectorXd& t) {
  const Index count = t.size() - kOrder;
  MatrixXd gram = MatrixXd::Zero(count, count);
  for (Index i = 0; i + 1 < t.size(); ++i) {
    const Index first = std::max(Index{0}, i + 1 - kOrder), last = std::min(i, count - 1);
    integrate(t, i, [&](double u, double weight) {
      for (Index k = first; k <= last; ++k)
        for (Index l = first; l <= last; ++l)
          gram(k, l) += weight * b_spline(t, k, u) * b_spline(t, l, u);
    });
  }
  return gram.sparseView();
}

/// Maps values at the times to derivatives there, of the natural quintic spline through them: the
/// mean given the values if the third derivative is white noise.
struct Differentiation {
  MatrixXd map;
  VectorXd variance;  ///< one per derivative, given the values, for white noise of intensity 1
};

/// Peano: the error of the derivative of the parabola through three values is the integral of the
/// third derivative, times the error for (t - u)_+^2 / 2.
Differentiation differentiation(const VectorXd& t,
                                Index order,
                                const SparseMatrix& differences,
                                const Banded& gram) {
  const Index n = t.size(), count = n - kOrder;
  Differentiation result{MatrixXd::Zero(n, n), VectorXd::Zero(n)};
  MatrixXd products = MatrixXd::Zero(count, n);
  for (Index i = 0; i < n; ++i) {
    const Index from = std::clamp(i - 1, Index{0}, n - kOrder);
    const VectorXd d = derivative_weights(t.segment(from, kOrder), t(i), order);
    result.map.row(i).segment(from, kOrder) = d.transpose();
    for (Index interval = from; interval < from + 2; ++interval)
      integrate(t, interval, [&](double u, double weight) {
        double kernel = t(i) > u ? (order == 1 ? t(i) - u : 1) : 0;
        for (Index j = 0; j < kOrder; ++j) kernel -= 0.5 * d(j) * square_after(t(from + j), u);
        result.variance(i) += weight * kernel * kernel;
        for (Index k = std::max(Index{0}, interval + 1 - kOrder);
             k <= std::min(interval, count - 1);
             ++k)
          products(k, i) += weight * kernel * b_spline(t, k, u);
      });
  }
  const MatrixXd solved = gram.solve(products);
  result.map += solved.transpose() * differences;
  result.variance -= (solved.array() * products.array()).colwise().sum().matrix().transpose();
  result.variance = result.variance.cwiseMax(0);
  return result;
}

/// White noise of the third derivative, before the values are seen.
struct Roughness {
  double intensity = 0;
  VectorXd shrinkage;  ///< one factor per eigenvector
};

/// Returns the most likely roughness; the values have these squares along the eigenvectors.
Roughness likely_roughness(const VectorXd& roughness, const VectorXd& squares, double variance) {
  constexpr int kSteps = 60;
  constexpr double kRatio = 3;
  const Index n = roughness.size();
  const Eigen::ArrayXd rough = roughness.tail(n - kOrder), square = squares.tail(n - kOrder);
  Roughness best{0, VectorXd::Ones(n)};
  if (!(variance > 0)) {
    best.intensity = (square * rough).mean();
    return best;
  }
  double least = std::numeric_limits<double>::infinity();
  double intensity = 1e-6 * variance * roughness(n - 1);
  for (int k = 0; k < kSteps; ++k, intensity *= kRatio) {
    const Eigen::ArrayXd all = intensity / rough + variance;
    const double minus_log = (all.log() + square / all).sum();
    if (minus_log >= least) continue;
    least = minus_log;
    best.intensity = intensity;
  }
  best.shrinkage.tail(n - kOrder) = best.intensity / (best.intensity + variance * rough);
  return best;
}

}  // namespace

PathTimes path_times(const VectorXd& times_s) {
  const Index n = times_s.size();
  PathTimes times{.duration_s = n > 0 ? times_s(n - 1) - times_s(0) : 0};
  if (n <= kOrder + 1) return times;
  const SparseMatrix differences = third_differences(times_s);
  const Banded gram(gram_matrix(times_s));
  auto first = differentiation(times_s, 1, differences, gram);
  times.first = std::move(first.map);
  times.first_variance = std::move(first.variance);
  times.second = differentiation(times_s, 2, differences, gram).map;
  auto [roughness, vectors] =
      symmetric_eigen(differences.transpose() * gram.solve(MatrixXd(differences)));
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
    const double variance = noise(c) * noise(c);
    const auto [intensity, shrinkage] =
        likely_roughness(times.roughness, along.col(c).cwiseAbs2(), variance);
    if (variance > 0) smooth.col(c) = times.vectors * shrinkage.cwiseProduct(along.col(c));
    sigma.col(c) =
        (variance * (first_along.cwiseAbs2() * shrinkage) + intensity * times.first_variance)
            .cwiseSqrt();
  }
  return {times.first * smooth, times.second * smooth, sigma};
}

std::vector<Velocity> smooth_velocities(const PathTimes& times,
                                        const PlaneMotion& motion,
                                        const PathNoise& noise) {
  const auto n = std::ssize(motion.tau);
  // The integral of the rates in the camera's axes, which a logarithm of the whole rotation is only
  // for small ones.
  MatrixXd path(n, 6);
  Vector3d turned_rad = Vector3d::Zero();
  for (Index i = 0; i < n; ++i) {
    if (i > 0) turned_rad += so3_log(motion.R_wc[i - 1].transpose() * motion.R_wc[i]);
    path.row(i) << motion.tau[i].transpose(), turned_rad.transpose();
  }
  VectorXd sigmas(6);
  sigmas << Vector3d::Constant(noise.tau), Vector3d::Constant(noise.rotation_rad);
  const auto [first, second, sigma] = smooth_derivatives(times, path, sigmas);
  std::vector<Velocity> velocities(n);
  for (Index i = 0; i < n; ++i) {
    velocities[i] = {first.row(i).tail<3>(),
                     second.row(i).tail<3>(),
                     first.row(i).head<3>(),
                     second.row(i).head<3>(),
                     sigma.row(i).tail<3>().norm() / std::sqrt(3.0),
                     sigma.row(i).head<3>().norm() / std::sqrt(3.0)};
  }
  return velocities;
}

}  // namespace gpo
