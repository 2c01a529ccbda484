// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/synthesis/recipe.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// What the IMU reads. The gyroscope has bias and white noise; the accelerometer is perfect.
struct ImuSample {
  std::int64_t timestamp_ns;
  Eigen::Vector3d rate_b;            ///< [rad/s]
  Eigen::Vector3d specific_force_b;  ///< [m/s^2]
};

/// Samples from 0.1 s before the first to 0.1 s after the last frame, between the frames' times.
std::vector<ImuSample> simulate_imu(const Recipe& recipe);

/// Called after each frame and, with none done, after each part of the scene that is painted before
/// the first; stops everything where it throws.
using SynthesisProgress = std::function<void(int frames_done, int frames)>;

/// Writes the recording as an EuRoC folder (README, "Recordings") with its truth, `plane.yaml` and
/// `board.yaml`. World: the desk is z = 0, z up; where there is none, there is no `plane.yaml`.
/// Same recipe, same bytes, whatever the threads. Throws InputError where `output` exists and is
/// not empty, or cannot be written; a folder that is not finished is never left behind.
void synthesize(const Recipe& recipe,
                const std::filesystem::path& output,
                const SynthesisProgress& progress = {},
                int threads = 2);

}  // namespace gpo
