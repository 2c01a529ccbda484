// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inertial/inertial_alignment.h"

#include <optional>

namespace gpo {

/// The first `count` poses, and what is not known of them.
UncertainPoses first_poses(const UncertainPoses& poses, int count);

/// How many of the poses, from the first one on, it takes to know the scale: the shortest such
/// beginning, found by halving, since more poses tell more. The poses are those of the whole
/// window, so a live window may take longer. Nothing where all of them do not tell it.
std::optional<int> poses_that_constrain_scale(const UncertainPoses& poses,
                                         const Gyroscope& gyroscope,
                                         const std::optional<Pose>& T_body_camera,
                                         const InertialOptions& options = {});

}  // namespace gpo
