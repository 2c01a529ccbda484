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

// The files that loggers write beside a video. All throw InputError.

/// Gyroflow's log: lines of KEY,VALUE, then a table `t,gx,gy,gz,...` in units of `tscale` [s] and
/// `gscale` [rad/s]. Its time is the video's, from the first frame on.
Log read_gcsv(const std::filesystem::path& file);

/// `Gyroscope.csv` of Sensor Logger: `time` [ns], `seconds_elapsed` and rates [rad/s] by their
/// names. What has elapsed is taken as the video's time.
Log read_sensor_logger(const std::filesystem::path& file);

/// A folder of Stray Scanner: `imu.csv`, `odometry.csv` (ARKit's poses of the camera, one a
/// picture) and `camera_matrix.csv`.
Log read_stray_scanner(const std::filesystem::path& folder);

/// `data.jsonl` of Spectacular AI, with what `calibration.json` beside it says of the camera.
Log read_spectacular(const std::filesystem::path& file);

}  // namespace gpo
