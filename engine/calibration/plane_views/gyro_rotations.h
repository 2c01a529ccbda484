// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_views.h"
#include "engine/window/gyroscope.h"

#include <cstdint>
#include <span>
#include <vector>

namespace gpo {

/// How a gyroscope saw the camera turn between sights of a plane that follow one another. Without
/// those that its samples do not cover.
GyroRotations gyro_rotations(const Gyroscope& gyroscope,
                     std::span<const std::int64_t> frame_times_ns,
                     const std::vector<ObservedPlane>& planes);

}  // namespace gpo
