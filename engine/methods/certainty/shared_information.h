// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/methods/common/uncertainty.h"
#include "engine/methods/plane/plane_kernel.h"
#include "engine/window/window.h"

#include <optional>
#include <span>

#include <Eigen/Core>

namespace gpo {

/// Information on what the frames share, the translations (and free rotations) marginalized, per
/// square pixel of noise: over the normal's tangents u and, with an unknown bias, the bias.
using SharedInformation = Eigen::MatrixXd;

/// What the prior says before the first frame.
SharedInformation prior_information(const Window& window, RotationModel model, double sigma_px);
/// What one frame adds; `normals` with rotation.
SharedInformation frame_information(const Window& window,
                                    int frame,
                                    const FrameNormals& normals,
                                    RotationModel model);

/// Standard deviation of the normal's angle, root of its covariance's trace [deg]; nothing where it
/// is not determined.
std::optional<double> normal_sigma_deg(const SharedInformation& information, double sigma_px);

/// Cramer-Rao bound of the normal's angle [deg] (engine/method.md, eq. 13 and 14): the root of the
/// trace of its covariance with the translations unknown, rotations known, reference points exact
/// and independent noise of `sigma_px` on each coordinate of the inlier observations; nullopt where
/// the window does not determine it.
std::optional<double> normal_bound_deg(const Window& window,
                                       const Plane& plane,
                                       std::span<const Pose> cameras,
                                       double sigma_px);

/// The inverse, where the matrix is positive definite beyond rounding once its rows are scaled.
std::optional<Eigen::MatrixXd> inverse_information(const Eigen::MatrixXd& information);

}  // namespace gpo
