// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/synthesis/recipe.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
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

/// Where the recording of a recipe is kept: cache/STEM-HASH/STEM, so that it is called after its
/// recipe, and an edited recipe has another place. Throws InputError where there is no such file.
std::filesystem::path synthesized_folder(const std::filesystem::path& recipe,
                                         const std::filesystem::path& cache);

/// The folders of the recipes' recordings, in their order; makes those that are not there yet, some
/// at a time. Where another process makes one of them, waits for it. `progress` counts the frames
/// of all that are being made; it is never called by two threads at a time, and stops everything
/// where it throws. Throws InputError; what is not finished is never left behind.
std::vector<std::filesystem::path> synthesized_recordings(
    std::span<const std::filesystem::path> recipes,
    const std::filesystem::path& cache,
    int threads,
    const SynthesisProgress& progress = {});

}  // namespace gpo
