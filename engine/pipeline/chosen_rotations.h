// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/inliers.h"
#include "engine/frontend/rotations.h"
#include "engine/window/gyroscope.h"
#include "engine/window/window.h"

#include <span>
#include <stop_token>
#include <string>

#include <Eigen/Core>

namespace gpo {

/// The rotations of a window and where they are from.
struct ChosenRotations {
  RotationSource source = RotationSource::gyro;  ///< never automatic, nor raw
  Rotations rotations = {};
  std::string note = "";  ///< why what `automatic` tries first had none; what told them
};

/// What is tried first: of `automatic` the calibrated gyroscope, else five-point rotations; of
/// `raw` the gyroscope as it is, else averaging; any other itself.
RotationSource first_source(RotationSource asked, bool has_gyroscope);

/// The window's rotations from what is asked for. Of `automatic`, where pictures cannot calibrate
/// the gyroscope it is taken as it is, and where five-point rotations are refused homographies are
/// averaged. `gyroscope` may be null for those who need none; `R_wc_true`, one a frame, may be
/// empty for all but the truth. `ransac` has the threshold and the seed of all tracks' relative
/// poses. Throws InputError where the gyroscope does not cover the window.
ChosenRotations chosen_rotations(const Window& window,
                                 const Gyroscope* gyroscope,
                                 std::span<const Eigen::Matrix3d> R_wc_true,
                                 RotationSource asked,
                                 const RansacOptions& ransac,
                                 const std::stop_token& stop);

}  // namespace gpo
