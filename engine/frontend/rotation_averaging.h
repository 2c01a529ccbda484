// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Measured rotation between two frames: x_i = R_ij x_j for directions.
struct RelativeRotation {
  int i;
  int j;
  Eigen::Matrix3d R_ij;
  double weight = 1;  ///< inverse variance, any unit
};

/// Averages rotations robustly (Chatterjee & Govindu, ICCV 2013), starting from `R_wc`: least
/// absolute deviations, then iteratively reweighted least squares. Frame 0 keeps its rotation.
std::vector<Eigen::Matrix3d> average_rotations(std::span<const RelativeRotation> relative,
                                               std::vector<Eigen::Matrix3d> R_wc);

}  // namespace gpo
