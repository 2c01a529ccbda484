// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/plane/calibration_problem.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace gpo {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using LensMatrix = Eigen::Matrix<double, kLensUnknowns, kLensUnknowns>;
using LensColumns = Eigen::Matrix<double, Eigen::Dynamic, kLensUnknowns>;
using Factors = Eigen::SimplicialLDLT<Sparse>;

using Cell = std::array<int, 3>;  // plane and place, or place in the image
using Moves = std::map<Cell, LensVector>;

constexpr int kStretches = 10;
constexpr int kRegions = 4;        // in each direction of the image
constexpr double kPatch = 0.05;    // size of a part of a plane [distances]
constexpr double kDamping = 1e-9;  // keeps blocks that lose all observations in place

struct Linear {
  SparseRows J;
  Eigen::VectorXd r;
  std::vector<const ResidualSource*> sources;  ///< one per row
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
  for (const ResidualSource& source : problem.sources())
    linear.sources.insert(linear.sources.end(), source.rows, &source);
  return linear;
}

Sparse normal_matrix(const SparseRows& J) {
  Sparse normal = Sparse(J.transpose()) * Sparse(J);
  for (Eigen::Index k = 0; k < normal.cols(); ++k)
    normal.coeffRef(k, k) += kDamping * (1 + normal.coeff(k, k));
  return normal;
}

/// Points of several references in the same place of a plane are one texture.
Cell patch_of(const ResidualSource& source, const Adjustment& adjustment) {
  const Eigen::Vector3d point = adjustment.planes[source.plane].points.col(source.point);
  const Eigen::Vector2i cell = (point.head<2>() / kPatch).array().floor().cast<int>();
  return {source.plane, cell.x(), cell.y()};
}

Cell region_of(const PlaneData& data, const ResidualSource& source) {
  const PlaneView& view = data.planes[source.plane].views[source.view];
  const auto column = std::ranges::lower_bound(view.points, source.point) - view.points.begin();
  const Eigen::Array2d place =
      view.raw_px.col(column).array() / Eigen::Array2d(data.width, data.height);
  const Eigen::Array2i cell = (kRegions * place).floor().cast<int>();
  return {0, cell.x(), cell.y()};
}

LensMatrix outer_sum(const Moves& moves) {
  LensMatrix sum = LensMatrix::Zero();
  for (const auto& [key, move] : moves) sum += move * move.transpose();
  const auto groups = static_cast<double>(moves.size());
  return groups > 1 ? LensMatrix(sum * groups / (groups - 1)) : sum;
}

/// Covariance of the lens by leaving out stretches of time, each solved again to first order.
LensMatrix stretch_covariance(const std::vector<ObservedPlane>& planes,
                              const Linear& linear,
                              const Sparse& normal,
                              Factors& factors) {
  std::vector<LensVector> moves;
  for (int stretch = 0; stretch < kStretches; ++stretch) {
    Eigen::VectorXd chosen = Eigen::VectorXd::Zero(linear.r.size());
    for (Eigen::Index row = 0; row < chosen.size(); ++row) {
      const auto& [plane, view, point, rows, sigma_px] = *linear.sources[row];
      if (plane < 0) continue;
      const auto views = std::ssize(planes[plane].views);
      if (view * std::ptrdiff_t{kStretches} / views == stretch) chosen[row] = 1;
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
  return groups > 3 ? LensMatrix(sum * std::pow(groups - 1, 2) / groups / (groups - 3)) : sum;
}

}  // namespace

LensCertainty lens_certainty(const PlaneData& data, const Adjustment& adjustment, double noise_px) {
  Adjustment at = adjustment;
  CalibrationProblem problem(data, at);
  const Linear linear = linearized(problem);
  const Sparse normal = normal_matrix(linear.J);
  Factors factors(normal);
  if (factors.info() != Eigen::Success)
    return {LensVector::Constant(INFINITY), LensVector::Constant(INFINITY), LensMatrix::Zero()};
  LensColumns first_columns = LensColumns::Zero(normal.cols(), kLensUnknowns);
  first_columns.topRows<kLensUnknowns>().setIdentity();
  const LensColumns Y = factors.solve(first_columns);
  const LensMatrix inverse = Y.topRows<kLensUnknowns>();
  // Each row moves the lens by its residual times its row of JY; priors have their sigma instead.
  const LensColumns JY = linear.J * Y;
  Moves patches, regions;
  LensMatrix observations = LensMatrix::Zero();
  LensMatrix priors = LensMatrix::Zero();
  LensVector one = LensVector::Zero();
  for (Eigen::Index row = 0; row < JY.rows(); ++row) {
    const ResidualSource& source = *linear.sources[row];
    if (source.plane < 0) {
      priors += source.sigma_px * source.sigma_px * JY.row(row).transpose() * JY.row(row);
      continue;
    }
    const LensVector move = JY.row(row).transpose() * linear.r[row];
    patches.try_emplace(patch_of(source, adjustment), LensVector::Zero()).first->second += move;
    regions.try_emplace(region_of(data, source), LensVector::Zero()).first->second += move;
    one += move;
    if (row + 1 < JY.rows() && linear.sources[row + 1] == &source) continue;
    observations += one * one.transpose();
    one.setZero();
  }
  const LensMatrix by_patch = outer_sum(patches) + priors;
  const LensMatrix by_region = outer_sum(regions) + priors;
  const LensMatrix by_stretch = stretch_covariance(data.planes, linear, normal, factors) + priors;
  const LensVector own = noise_px * inverse.diagonal().cwiseMax(0).cwiseSqrt();
  const LensMatrix sum = by_patch + by_region + by_stretch;
  const LensVector all = (sum - 2 * (observations + priors)).diagonal();
  const LensVector variance = all.cwiseMax(by_patch.diagonal())
                                  .cwiseMax(by_region.diagonal())
                                  .cwiseMax(by_stretch.diagonal())
                                  .cwiseMax(own.cwiseAbs2());
  const LensVector wider = variance.cwiseQuotient(sum.diagonal()).cwiseSqrt();
  return {variance.cwiseSqrt(), own, wider.asDiagonal() * sum * wider.asDiagonal()};
}

}  // namespace gpo
