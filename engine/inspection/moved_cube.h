// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <Eigen/Core>

namespace gpo {

/// Moves the middle of both cubes' bases (of the default side) to where a ray of the reference
/// camera meets their planes, so that both stand at one place of the scene; they keep their axes.
/// The reference camera is where the two worlds are known to meet: what an alignment of the paths
/// leaves of scale and rotation would show as a shift. Both stay where the ray misses the estimated
/// plane; where it misses the true one alone there is no true cube.
void move_cubes(Inspection& inspection, const Eigen::Vector3d& ray_c);

}  // namespace gpo
