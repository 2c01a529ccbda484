// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/window.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// First-order uncertainty of a solution (engine/method.md, eq. 13 to 15), in the gauge of an
/// initialization (world = reference camera, d = 1); independent noise of `sigma_px` on each
/// coordinate of the inliers, reference points exact, what `rotations` leaves unknown marginalized.
/// Where a method takes a gyroscope's rotations as known, their bias is wrong as its prior says,
/// and the result with it.
struct Uncertainty {
  double sigma_px = 0;  ///< from the residuals, unknowns counted
  RotationModel rotations = RotationModel::known;
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Zero();  ///< [rad^2], rank 2
  double normal_sigma_deg = 0;                                  ///< root of its trace
  std::vector<Eigen::Matrix3d> center_covariances;  ///< of p_wc, one a frame; zero of the first
  std::vector<double> distance_ratio_sigmas;  ///< of d_i / d_1, the plane's distance from camera i
  std::optional<Eigen::Matrix3d> bias_covariance;  ///< [(rad/s)^2], gyroscope's axes
  /// Cramer-Rao bounds of the normal's angle [deg] at this solution.
  std::optional<double> bound_known_rotations_deg;
  std::optional<double> bound_unknown_bias_deg;  ///< with a gyroscope only
};

}  // namespace gpo
