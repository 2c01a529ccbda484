// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/rotation_averaging.h"

#include "engine/geometry/decompositions.h"
#include "engine/geometry/pose.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSmallestRad = 1e-4;  // limits the weight of a perfect pair

/// Returns x, frames x 3, that minimizes sum w |x_j - x_i - r|^2 with x_0 = 0.
Eigen::MatrixX3d solve_step(std::span<const RelativeRotation> relative,
                            const std::vector<Vector3d>& residuals,
                            const std::vector<double>& weights,
                            Eigen::Index frames) {
  Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(frames, frames);
  Eigen::MatrixX3d right = Eigen::MatrixX3d::Zero(frames, 3);
  for (std::size_t k = 0; k < relative.size(); ++k) {
    const auto& [i, j, R_ij, unused] = relative[k];
    const double w = weights[k];
    laplacian(i, i) += w;
    laplacian(j, j) += w;
    laplacian(i, j) -= w;
    laplacian(j, i) -= w;
    right.row(j) += w * residuals[k].transpose();
    right.row(i) -= w * residuals[k].transpose();
  }
  Eigen::MatrixX3d x = Eigen::MatrixX3d::Zero(frames, 3);
  x.bottomRows(frames - 1) = solve_symmetric(laplacian.bottomRightCorner(frames - 1, frames - 1),
                                             right.bottomRows(frames - 1));
  return x;
}

/// Lie-algebraic averaging with the weight function `weight` of |residual| [rad].
void average(std::span<const RelativeRotation> relative,
             std::vector<Matrix3d>& R_wc,
             int rounds,
             const std::function<double(double)>& weight) {
  for (int round = 0; round < rounds; ++round) {
    std::vector<Vector3d> residuals;
    std::vector<double> weights;
    for (const auto& [i, j, R_ij, w] : relative) {
      // With R_wc <- exp(x) R_wc the residual log(R_wi R_ij R_wj^T) becomes r + x_i - x_j.
      residuals.push_back(so3_log(R_wc[i] * R_ij * R_wc[j].transpose()));
      weights.push_back(w * weight(residuals.back().norm()));
    }
    const auto frames = static_cast<Eigen::Index>(R_wc.size());
    const Eigen::MatrixX3d x = solve_step(relative, residuals, weights, frames);
    if (!x.allFinite()) return;
    for (Eigen::Index i = 1; i < frames; ++i) R_wc[i] = so3_exp(x.row(i).transpose()) * R_wc[i];
    if (x.rowwise().norm().maxCoeff() < 1e-10) return;
  }
}

}  // namespace

std::vector<Matrix3d> average_rotations(std::span<const RelativeRotation> relative,
                                        std::vector<Matrix3d> R_wc) {
  average(relative, R_wc, 30, [](double r) { return 1 / std::max(r, kSmallestRad); });
  // The l_1/2 weights of Chatterjee & Govindu 2018 tolerate more outliers.
  average(relative, R_wc, 30, [](double r) { return std::pow(std::max(r, kSmallestRad), -1.5); });
  return R_wc;
}

}  // namespace gpo
