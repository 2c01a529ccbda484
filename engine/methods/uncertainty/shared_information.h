// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/methods/plane/plane_kernel.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/window/window.h"

#include <optional>
#include <span>

#include <Eigen/Core>

namespace gpo {

/// Information about the normal (tangents u) and, with an unknown bias, bias and time offset, with
/// translations and free rotations marginalized, per square pixel of noise.
using SharedInformation = Eigen::MatrixXd;

/// Returns the information of the priors of bias and time offset, if these are unknown.
SharedInformation prior_information(const Window& window,
                                    const UnknownsLayout& layout,
                                    double sigma_px);
/// Returns the information of one frame; `normals` with rotation.
SharedInformation frame_information(const Window& window,
                                    int frame,
                                    const FrameNormals& normals,
                                    RotationModel model);

/// Returns the standard deviation of the normal's angle, the root of its covariance's trace [deg];
/// nullopt if it is not determined.
std::optional<double> normal_sigma_deg(const SharedInformation& information, double sigma_px);

/// Returns the Cramér-Rao bound of the normal's angle [deg] (engine/method.md, eq. 13 and 14) with
/// unknown translations, known rotations, exact reference points and independent noise of
/// `sigma_px` on each coordinate of the inlier observations; nullopt if the window does not
/// determine it.
std::optional<double> normal_bound_deg(const Window& window,
                                       const Plane& plane,
                                       std::span<const Pose> cameras,
                                       double sigma_px);

/// Returns the inverse if the matrix is positive definite beyond rounding after scaling its rows.
std::optional<Eigen::MatrixXd> inverse_information(const Eigen::MatrixXd& information);

}  // namespace gpo
