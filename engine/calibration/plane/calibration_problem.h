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

/// The least squares of `adjust`. It changes the unknowns in place.
class CalibrationProblem {
 public:
  CalibrationProblem(const PlaneData& data, Adjustment& unknowns);

  void solve();

  const std::vector<ResidualSource>& sources() const { return sources_; }
  /// Evaluates residuals and Jacobian, weighted by the loss; the lens has the first columns.
  void evaluate(std::vector<double>& residuals, ceres::CRSMatrix& jacobian);

 private:
  void add_views();
  void add_rotations();
  void hold_gauge();
  void add_heights();

  const PlaneData& data_;
  Adjustment& unknowns_;
  ceres::Problem problem_;
  std::vector<ResidualSource> sources_;
  std::vector<double*> free_blocks_;
};

}  // namespace gpo
