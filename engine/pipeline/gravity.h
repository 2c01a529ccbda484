// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"
#include "engine/inertial/inertial_alignment.h"
#include "engine/inertial/uncertain_poses.h"
#include "engine/methods/common/initialization.h"
#include "engine/window/gyroscope.h"
#include "engine/window/window.h"

#include <optional>

namespace gpo {

/// Gravity and meters of a result that is ok and its poses. `Gravity::joint`: the result moves to
/// where pictures and accelerations agree best, planes, poses, bias and their covariances, where it
/// comes with the joint covariance that this takes; else it stays.
InertialAlignment find_gravity(const Window& window,
                               const UncertainPoses& poses,
                               const Gyroscope& gyroscope,
                               const std::optional<Pose>& T_body_camera,
                               Gravity when,
                               Initialization& result);

}  // namespace gpo
