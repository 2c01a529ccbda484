// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/lens_fit.h"

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A solution with its uncertainty.
struct LensEstimate {
  std::optional<LensFit> solution;     ///< nullopt if the views do not determine a camera
  std::optional<Readout> readout;      ///< nullopt if it is not known and insignificant
  std::vector<double> sigmas;          ///< one per parameter; empty if single views decide
  Eigen::MatrixXd covariance;          ///< with these standard deviations
  std::vector<CalibrationView> views;  ///< without those that fit far worse than the others
  bool bent = false;                   ///< with the shape of the board
};

/// Least number of views of a calibration.
inline constexpr int kLeastViews = 8;

/// Estimates camera and readout (see `calibrate_camera`). Fixes undetermined coefficients at 0, one
/// after the other, and appends a sentence on each to `left_at_0`.
LensEstimate estimate_lens(const std::vector<CalibrationView>& views,
                           const Board& board,
                           const Camera& start,
                           std::vector<std::string>& left_at_0);

}  // namespace gpo
