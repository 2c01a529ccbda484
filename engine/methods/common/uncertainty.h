// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/window.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Of a plane beside the leading one.
struct PlaneUncertainty {
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Zero();  ///< [rad^2], rank 2
  double log_distance_sigma = 0;  ///< of the log of its distance from the reference camera [-]
};

/// First-order uncertainty of a solution (engine/method.md, eq. 13 to 15), in the gauge of an
/// initialization (world = reference camera, d = 1), what `rotations` leaves unknown marginalized.
/// It rests on what the residuals say, not on a model of them: errors of a track in all its frames
/// may share a cause, and so may those of a frame in all its tracks (covariance clustered both
/// ways). Where a method takes a gyroscope's rotations as known, their bias is wrong as far as it
/// is unknown, and the result with it. The lens is as
/// uncertain as its calibration says, or taken as exact.
struct Uncertainty {
  double sigma_px = 0;  ///< of a coordinate, from the residuals, unknowns counted
  int tracks = 0;       ///< on which it rests
  RotationModel rotations = RotationModel::known;
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Zero();  ///< [rad^2], rank 2
  double normal_sigma_deg = 0;                                  ///< root of its trace
  /// Its part that comes from a plane that is none: how far its normal varies over the tracks,
  /// where that stands out of the noise.
  std::optional<double> bend_sigma_deg;
  /// The part of what neighboring tracks have wrong together, where that stands out.
  std::optional<double> neighbors_sigma_deg;
  std::optional<double> lens_sigma_deg;  ///< the lens' part of it; nothing: taken as exact
  std::vector<Eigen::Matrix3d> center_covariances;  ///< of p_wc, one a frame; zero of the first
  /// Of all p_wc but the first at once, stacked; where it is uncertain what bias a gyroscope had,
  /// of that (3 more rows); of each plane, the leading one first, its normal along
  /// `normal_tangents` (2 more rows), of further ones the log of 1 / distance, too: errors of
  /// neighboring frames are alike, and go with those of the planes. Empty: not computed.
  Eigen::MatrixXd joint_covariance;
  int joint_bias_rows = 0;                    ///< 3: it has those of the bias
  std::vector<double> distance_ratio_sigmas;  ///< of d_i / d_1, the plane's distance from camera i
  std::vector<PlaneUncertainty> others;       ///< of the further planes, in their order
  std::optional<Eigen::Matrix3d> bias_covariance;  ///< [(rad/s)^2], gyroscope's axes
  /// Cramer-Rao bounds of the normal's angle [deg] at this solution.
  std::optional<double> bound_known_rotations_deg;
  std::optional<double> bound_unknown_bias_deg;  ///< with a gyroscope only
};

}  // namespace gpo
