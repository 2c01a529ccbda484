// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inertial/inertial_alignment.h"
#include "engine/inertial/uncertain_poses.h"
#include "engine/methods/common/initialization.h"
#include "engine/methods/common/sources.h"
#include "engine/window/window.h"

namespace gpo {

/// Estimates gravity and metric scale of a result that is ok. `Gravity::joint` also changes the
/// result, its planes, poses, bias and their covariances, to where images and accelerations agree
/// best, if it has the joint covariance. `sources` has a gyroscope.
InertialAlignment find_gravity(const Window& window,
                               const Sources& sources,
                               const UncertainPoses& poses,
                               Gravity when,
                               Initialization& result);

}  // namespace gpo
