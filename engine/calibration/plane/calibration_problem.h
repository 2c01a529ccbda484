// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_lens.h"

#include <ceres/ceres.h>

namespace gpo {

/// Origin of some rows of the problem's Jacobian.
struct ResidualSource {
  int plane = -1;  ///< -1 for a prior or the gyroscope
  int view = 0;
  int point = 0;
  int rows = 2;
  double sigma_px = 0;  ///< weight of a prior's rows
};

/// The least squares of `adjust`.
class CalibrationProblem {
 public:
  CalibrationProblem(const PlaneData& data, Adjustment& unknowns);

  /// Changes the unknowns.
  void solve();

  const std::vector<ResidualSource>& sources() const { return sources_; }
  /// Evaluates residuals and Jacobian, weighted by the loss; the lens has the first columns.
  void evaluate(std::vector<double>& residuals, ceres::CRSMatrix& jacobian);

 private:
  void copy_unknowns();
  double* point(std::size_t plane, Eigen::Index j) { return points_[plane] + 3 * j; }
  double* pose(std::size_t plane, std::size_t view) { return poses_[plane] + 6 * view; }
  void add_views();
  void add_rotations();
  void hold_gauge();
  void add_heights();

  const PlaneData& data_;
  Adjustment& unknowns_;
  /// All unknowns in one array, because Ceres eliminates blocks in the order of their addresses.
  std::vector<double> values_;
  double* lens_ = nullptr;
  double* bias_ = nullptr;
  std::vector<double*> points_, poses_;  ///< addresses in it for each plane
  ceres::Problem problem_;
  std::vector<ResidualSource> sources_;
  std::vector<double*> free_blocks_;
};

}  // namespace gpo
