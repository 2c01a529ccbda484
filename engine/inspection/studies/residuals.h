// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// H_i1 = K R_ciw (I - tau_i n^T) K^-1 by the result's plane and poses, undistorted. Nothing where
/// the initialization failed.
std::optional<Eigen::Matrix3d> estimated_homography(const Inspection& inspection,
                                                    int frame_in_window);

/// Lengths of the inliers' residuals in a frame of the window [raw px]: from where a track was seen
/// to where the result puts what the reference frame saw. Empty where the initialization failed.
std::vector<double> residuals_px(const Inspection& inspection, int frame_in_window);

}  // namespace gpo
