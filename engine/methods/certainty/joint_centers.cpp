// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/joint_centers.h"

#include <algorithm>

namespace gpo {
namespace {

/// How what is shared moves the centers, p_wc = -tau with tau_i + R_wci t, t = -gain x; and the
/// bias and the planes, which are among it.
Eigen::MatrixXd all_by_shared(const PlaneMotion& motion, const Bread& bread, int bias_rows) {
  const auto frames = static_cast<Eigen::Index>(motion.tau.size());
  const int of_planes = bread.layout.of_gyro();
  Eigen::MatrixXd M =
      Eigen::MatrixXd::Zero(3 * (frames - 1) + bias_rows + of_planes, bread.layout.size());
  for (Eigen::Index i = 1; i < frames; ++i)
    M.middleRows<3>(3 * (i - 1)) = motion.R_wc[i] * bread.frames[i].gain.bottomRows<3>();
  if (bias_rows > 0) M.block<3, 3>(3 * (frames - 1), of_planes).setIdentity();
  M.bottomLeftCorner(of_planes, of_planes).setIdentity();
  return M;
}

}  // namespace

Eigen::MatrixXd joint_covariance(const PlaneMotion& motion,
                                 const Bread& bread,
                                 std::span<const SolutionMove> moves,
                                 const SharedMatrix& shared) {
  const auto frames = static_cast<Eigen::Index>(motion.tau.size());
  const int bias_rows = bread.layout.gyro > 0 ? 3 : 0;
  const Eigen::MatrixXd M = all_by_shared(motion, bread, bias_rows);
  const auto count = static_cast<Eigen::Index>(moves.size());
  Eigen::MatrixXd x(bread.layout.size(), count);
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(M.rows(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    x.col(k) = moves[k].shared;
    for (Eigen::Index i = 1; i < frames; ++i)
      own.col(k).segment<3>(3 * (i - 1)) = -motion.R_wc[i] * moves[k].own[i].tail<3>();
  }
  const Eigen::MatrixXd Z = M * x + own;
  const SharedMatrix rest = shared - x * x.transpose();
  Eigen::MatrixXd all = M * rest * M.transpose();
  all.selfadjointView<Eigen::Lower>().rankUpdate(Z);
  all.triangularView<Eigen::StrictlyUpper>() = all.transpose();
  return all;
}

}  // namespace gpo
