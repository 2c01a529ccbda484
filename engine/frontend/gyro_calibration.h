// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/rotations.h"
#include "engine/window/gyroscope.h"
#include "engine/window/window.h"

#include <span>
#include <stop_token>

#include <Eigen/Core>

namespace gpo {

struct GyroBias {
  Eigen::Vector3d bias_rad_s;  ///< in the gyroscope's axes
  Eigen::Matrix3d covariance;  ///< [(rad/s)^2]
};

/// The constant bias, in the gyroscope's axes, whose integrated rotations fit the visual
/// ones best: robust least squares over the frames, around the bias that the gyroscope comes with
/// (Gaussian, its `bias_sigma_rad_s`). Errors of the visual rotations share their cause, the
/// plane's normal, so that all frames together count as one: a short or ill-conditioned window,
/// which cannot tell, keeps the gyroscope's own bias.
GyroBias fit_gyro_bias(const Gyroscope& gyroscope,
                       std::span<const std::int64_t> frame_times_ns,
                       const Rotations& visual);

/// Rotations of the gyroscope less a constant bias that is estimated from the window's own visual
/// rotations (averaged homography decompositions; the gyroscope tells which of two planes). None
/// and a reason where there are no visual rotations.
Rotations calibrated_gyro_rotations(const Gyroscope& gyroscope,
                                    const Window& window,
                                    const std::stop_token& stop = {});

}  // namespace gpo
