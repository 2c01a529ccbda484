// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/closed_form_motion.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix3d;

/// The middle singular value, from the characteristic polynomial of M^T M: a fraction of the time
/// of an SVD, and as exact as a start needs.
double middle_singular_value(const Matrix3d& M) {
  Eigen::SelfAdjointEigenSolver<Matrix3d> eigen;
  eigen.computeDirect(M.transpose() * M, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, eigen.eigenvalues()(1)));
}

}  // namespace

Matrix3d translation_times_normal(const Window& window, int frame) {
  const Matrix3d H = window.R_wc[frame] * window.K.inverse() * window.H_i1[frame] * window.K;
  const double lambda = std::copysign(middle_singular_value(H), H.determinant());
  return Matrix3d::Identity() - H / lambda;
}

std::optional<PlaneMotion> closed_form_motion(const Window& window) {
  std::vector<Matrix3d> rank_one;  // tau_i n^T
  Matrix3d gram = Matrix3d::Zero();
  for (int i = 0; i < window.frame_count(); ++i) {
    rank_one.push_back(translation_times_normal(window, i));
    gram += rank_one.back().transpose() * rank_one.back();
  }
  if (!gram.allFinite()) return std::nullopt;
  PlaneMotion motion = resting(window);
  motion.normal = Eigen::SelfAdjointEigenSolver<Matrix3d>(gram).eigenvectors().col(2);
  for (int i = 1; i < window.frame_count(); ++i) motion.tau[i] = rank_one[i] * motion.normal;
  return facing(window, std::move(motion));
}

}  // namespace gpo
