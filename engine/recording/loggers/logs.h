// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/loggers/log.h"

#include <filesystem>
#include <optional>

namespace gpo {

/// What a logger wrote into a folder beside its video, if there is one: Stray Scanner's folder,
/// Spectacular AI's data.jsonl, Gyroflow's VIDEO.gcsv, Sensor Logger's Gyroscope.csv. Throws
/// InputError.
std::optional<Log> log_beside(const std::filesystem::path& folder,
                              const std::optional<std::filesystem::path>& video);

/// What a camera stored inside of its video: GoPro's GPMF, or Camera Motion Metadata. Times are
/// from the first frame on, which the container puts at `first_frame_s`. Throws InputError.
std::optional<Log> log_inside(const std::filesystem::path& video, double first_frame_s);

}  // namespace gpo
