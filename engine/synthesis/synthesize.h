// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/synthesis/recipe.h"

#include <functional>
#include <span>

namespace gpo {

/// A measurement of the IMU. The gyroscope has bias and white noise; the accelerometer is perfect.
struct ImuSample {
  std::int64_t timestamp_ns;
  Eigen::Vector3d rate_b;            ///< [rad/s]
  Eigen::Vector3d specific_force_b;  ///< [m/s^2]
};

/// Samples from 0.1 s before the first to 0.1 s after the last frame, never at a frame's time.
std::vector<ImuSample> simulate_imu(const Recipe& recipe);

/// Called after each frame, and with 0 before the scene is painted. If it throws, synthesis ends.
using SynthesisProgress = std::function<void(int frames_done, int frames)>;

/// Writes the recording as an EuRoC folder (README, "Recordings") with its truth, `plane.yaml` and
/// `board.yaml`. World: the desk is z = 0, z up; without a desk there is no `plane.yaml`. The same
/// recipe makes the same bytes with any number of threads on one kind of processor (with or without
/// AVX2 and FMA). Throws InputError if `output` exists and is not empty, or cannot be written;
/// never leaves an incomplete folder.
void synthesize(const Recipe& recipe,
                const fs::path& output,
                const SynthesisProgress& progress = {},
                int threads = 2);

/// Folder of a recipe's recording, cache/STEM-HASH/STEM, by name and content. Throws InputError.
fs::path synthesized_folder(const fs::path& recipe, const fs::path& cache);

/// Synthesizes missing recordings or waits for other processes; returns all folders in order.
/// `progress` counts all frames, by one thread at a time. Never leaves an incomplete folder.
std::vector<fs::path> synthesized_recordings(std::span<const fs::path> recipes,
                                             const fs::path& cache,
                                             int threads,
                                             const SynthesisProgress& progress = {});

}  // namespace gpo
