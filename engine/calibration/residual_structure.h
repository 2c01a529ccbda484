// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// The part of the residuals that different views share in one part of the image. Noise differs
/// from view to view, the error of a wrong lens model does not.
struct ResidualStructure {
  double rms_px = 0;        ///< root mean square of that part; 0 if there is none
  double share = 0;         ///< its share of the mean square of all residuals
  double significance = 0;  ///< standard deviations of the same from independent views
};

/// Compares views in 8 x 6 cells of an image of `size`. Each view has one column per corner: place
/// and residual [px].
ResidualStructure residual_structure(const std::vector<Eigen::Matrix4Xd>& views, cv::Size size);

}  // namespace gpo
