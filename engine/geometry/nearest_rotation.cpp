// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/nearest_rotation.h"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace gpo {

std::optional<Eigen::Matrix3d> nearest_rotation(const Eigen::Matrix3d& M, double most_skew) {
  constexpr double kRounding = 1e-12;
  const double skew = (M * M.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(skew <= most_skew) || M.determinant() < 0) return std::nullopt;
  if (skew <= kRounding) return M;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

}  // namespace gpo
