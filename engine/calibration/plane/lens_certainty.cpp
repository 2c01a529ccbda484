// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/plane/calibration_problem.h"
#include "engine/calibration/plane/plane_adjustment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace gpo {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using LensMatrix = Eigen::Matrix<double, kLensUnknowns, kLensUnknowns>;
using LensColumns = Eigen::Matrix<double, Eigen::Dynamic, kLensUnknowns>;
using Factors = Eigen::SimplicialLDLT<Sparse>;

constexpr int kStretches = 10;
constexpr double kDamping = 1e-9;  // what loses all that it rests on stays where it is

/// Everything linear about an adjusted problem.
struct Linear {
  SparseRows J;
  Eigen::VectorXd r;
  std::vector<int> source_of_row;
};

Linear linearized(CalibrationProblem& problem) {
  std::vector<double> residuals;
  ceres::CRSMatrix crs;
  problem.evaluate(residuals, crs);
  Linear linear;
  linear.J = Eigen::Map<const SparseRows>(crs.num_rows,
                                          crs.num_cols,
                                          static_cast<Eigen::Index>(crs.values.size()),
                                          crs.rows.data(),
                                          crs.cols.data(),
                                          crs.values.data());
  linear.r = Eigen::Map<const Eigen::VectorXd>(residuals.data(), std::ssize(residuals));
  for (std::size_t s = 0; s < problem.sources().size(); ++s)
    linear.source_of_row.insert(
        linear.source_of_row.end(), problem.sources()[s].rows, static_cast<int>(s));
  return linear;
}

/// J^T J with a little on its diagonal.
Sparse normal_matrix(const SparseRows& J) {
  Sparse normal = Sparse(J.transpose()) * Sparse(J);
  for (Eigen::Index k = 0; k < normal.cols(); ++k)
    normal.coeffRef(k, k) += kDamping * (1 + normal.coeff(k, k));
  return normal;
}

LensColumns first_columns(Eigen::Index size) {
  LensColumns unit = LensColumns::Zero(size, kLensUnknowns);
  unit.topRows<kLensUnknowns>().setIdentity();
  return unit;
}

/// Which stretch of time a sight is in, as many of each plane's sights in each.
int stretch_of(const std::vector<ObservedPlane>& planes, const ResidualSource& source) {
  const auto count = std::ssize(planes[source.plane].views);
  return static_cast<int>(source.view * std::ptrdiff_t{kStretches} / count);
}

LensMatrix outer_sum(const std::map<std::pair<int, int>, LensVector>& moves) {
  LensMatrix sum = LensMatrix::Zero();
  for (const auto& [key, move] : moves) sum += move * move.transpose();
  const auto groups = static_cast<double>(moves.size());
  return groups > 1 ? LensMatrix(sum * groups / (groups - 1)) : sum;
}

/// How far the lens moves without one stretch of time after the other: each one solved for anew, to
/// first order.
LensMatrix stretch_covariance(const std::vector<ObservedPlane>& planes,
                              const std::vector<ResidualSource>& sources,
                              const Linear& linear,
                              const Sparse& normal,
                              Factors& factors) {
  std::vector<LensVector> moves;
  for (int stretch = 0; stretch < kStretches; ++stretch) {
    Eigen::VectorXd chosen = Eigen::VectorXd::Zero(linear.r.size());
    for (Eigen::Index row = 0; row < chosen.size(); ++row) {
      const ResidualSource& source = sources[linear.source_of_row[row]];
      if (source.plane >= 0 && stretch_of(planes, source) == stretch) chosen[row] = 1;
    }
    if (chosen.sum() == 0) continue;
    const SparseRows own = chosen.asDiagonal() * linear.J;
    const Sparse left = normal - Sparse(Sparse(own.transpose()) * Sparse(own));
    factors.factorize(left);
    if (factors.info() != Eigen::Success) continue;
    const Eigen::VectorXd gradient = own.transpose() * linear.r;
    moves.emplace_back(factors.solve(gradient).head<kLensUnknowns>());
  }
  LensVector mean = LensVector::Zero();
  const auto groups = static_cast<double>(moves.size());
  for (const LensVector& move : moves) mean += move / groups;
  LensMatrix sum = LensMatrix::Zero();
  for (const LensVector& move : moves) sum += (move - mean) * (move - mean).transpose();
  return sum * (groups - 1) / std::max(1.0, groups);
}

}  // namespace

LensCertainty lens_certainty(const std::vector<ObservedPlane>& planes,
                             const GyroRotations& gyro,
                             int width,
                             int height,
                             const Adjustment& adjustment,
                             const LensPrior& prior,
                             double noise_px,
                             const PlaneAdjustmentOptions& options) {
  Adjustment at = adjustment;
  CalibrationProblem problem(planes, gyro, width, height, prior, options, at);
  const Linear linear = linearized(problem);
  const Sparse normal = normal_matrix(linear.J);
  Factors factors(normal);
  if (factors.info() != Eigen::Success)
    return {LensVector::Constant(INFINITY), LensVector::Constant(INFINITY)};
  const LensColumns Y = factors.solve(first_columns(normal.cols()));
  const LensMatrix inverse = Y.topRows<kLensUnknowns>();
  // Each row's move of the lens, and those of what is known beforehand.
  const LensColumns JY = linear.J * Y;
  std::map<std::pair<int, int>, LensVector> tracks;
  LensMatrix observations = LensMatrix::Zero();
  LensMatrix known = LensMatrix::Zero();
  LensVector one = LensVector::Zero();
  for (Eigen::Index row = 0; row < JY.rows(); ++row) {
    const ResidualSource& source = problem.sources()[linear.source_of_row[row]];
    if (source.plane < 0) {
      known += source.sigma_px * source.sigma_px * JY.row(row).transpose() * JY.row(row);
      continue;
    }
    const LensVector move = JY.row(row).transpose() * linear.r[row];
    const auto [entry, is_new] =
        tracks.try_emplace({source.plane, source.point}, LensVector::Zero());
    entry->second += move;
    one += move;
    if (row + 1 < JY.rows() && linear.source_of_row[row + 1] == linear.source_of_row[row]) continue;
    observations += one * one.transpose();
    one.setZero();
  }
  const LensMatrix by_track = outer_sum(tracks) + known;
  const LensMatrix by_stretch =
      stretch_covariance(planes, problem.sources(), linear, normal, factors) + known;
  const LensVector own = noise_px * inverse.diagonal().cwiseMax(0).cwiseSqrt();
  const LensVector both = (by_track + by_stretch - observations - known).diagonal();
  const LensVector variance =
      both.cwiseMax(by_track.diagonal()).cwiseMax(by_stretch.diagonal()).cwiseMax(own.cwiseAbs2());
  return {variance.cwiseSqrt(), own};
}

}  // namespace gpo
