// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/residual_structure.h"

#include <algorithm>
#include <cmath>

namespace gpo {

// With the sum s_vc of the n_vc residuals of view v in cell c, the products of different views
//   g_vw = sum_c s_vc . s_wc / n_c,  v != w,
// have mean 0 if views are independent, and the variance of their sum is 2 sum g_vw^2, as if each
// view had a random sign.
ResidualStructure residual_structure(const std::vector<Eigen::Matrix4Xd>& views, cv::Size size) {
  constexpr int kColumns = 8, kRows = 6, kCells = kColumns * kRows;
  const auto count = std::ssize(views);
  Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(count, kCells);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(count, 2 * kCells);
  double square = 0;
  for (Eigen::Index view = 0; view < count; ++view) {
    for (const auto& corner : views[view].colwise()) {
      const int column = static_cast<int>(corner(0) * kColumns / size.width);
      const int row = static_cast<int>(corner(1) * kRows / size.height);
      const int cell =
          std::clamp(row, 0, kRows - 1) * kColumns + std::clamp(column, 0, kColumns - 1);
      counts(view, cell) += 1;
      sums(view, cell) += corner(2);
      sums(view, kCells + cell) += corner(3);
      square += corner.tail<2>().squaredNorm();
    }
  }
  const Eigen::RowVectorXd all = counts.colwise().sum();
  const Eigen::RowVectorXd inverse = all.cwiseMax(1).cwiseInverse();
  const Eigen::RowVectorXd roots = inverse.cwiseSqrt().replicate<1, 2>();
  sums.array().rowwise() *= roots.array();
  Eigen::MatrixXd products = sums * sums.transpose();
  products.diagonal().setZero();
  const double pairs =
      ((all.cwiseAbs2() - counts.colwise().squaredNorm()).array() * inverse.array()).sum();
  if (!(pairs > 0) || !(square > 0)) return {};
  const double common = products.sum() / pairs;
  return {.rms_px = std::sqrt(std::max(0.0, common)),
          .share = common * all.sum() / square,
          .significance = products.sum() / std::max(1e-300, std::sqrt(2.0) * products.norm())};
}

}  // namespace gpo
