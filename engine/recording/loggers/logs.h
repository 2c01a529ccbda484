// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "engine/truth/truth.h"
#include "engine/window/gyroscope.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gpo {

/// A camera's or an app's own log of a video. The camera's axes are those of the image as stored in
/// the file, before a player rotates it.
struct Log {
  std::filesystem::path file;                   ///< for messages
  std::filesystem::path camera_file;            ///< source of `camera`
  std::optional<Camera> camera;                 ///< of size 0 if unknown
  std::optional<Pose> T_body_camera;            ///< body: the gyroscope's axes; nullopt if unknown
  std::optional<Gyroscope> gyroscope;           ///< without time offset and rotation to the camera
  std::filesystem::path frames_file;            ///< source of times and poses
  std::vector<std::int64_t> frame_times_ns;     ///< one for each image, ascending; empty if unknown
  std::vector<std::optional<Pose>> true_poses;  ///< of the camera at each image; empty if unknown
  std::optional<double> readout_s;              ///< as `Recording::readout_s`
  std::vector<std::string> notes;               ///< each shown once to the user
};

/// Reads the log that an app wrote into a folder beside its video: Stray Scanner's folder,
/// Spectacular AI's data.jsonl, Gyroflow's VIDEO.gcsv, Sensor Logger's Gyroscope.csv. nullopt if
/// there is none. Throws InputError.
std::optional<Log> log_beside(const std::filesystem::path& folder,
                              const std::optional<std::filesystem::path>& video);

/// Reads the log that a camera stored inside its video: GoPro's GPMF or Camera Motion Metadata.
/// Times are since the first frame, which the container puts at `first_frame_s`. nullopt if there
/// is none. Throws InputError.
std::optional<Log> log_inside(const std::filesystem::path& video, double first_frame_s);

// Readers of the files beside a video. All throw InputError.

/// Reads Gyroflow's log: lines of KEY,VALUE, then a table `t,gx,gy,gz,...` in units of `tscale` [s]
/// and `gscale` [rad/s], with times since the video's first frame.
Log read_gcsv(const std::filesystem::path& file);

/// Reads `Gyroscope.csv` of Sensor Logger: `time` [ns], `seconds_elapsed`, which is assumed to be
/// the video's time, and rates [rad/s] by their names.
Log read_sensor_logger(const std::filesystem::path& file);

/// Reads a folder of Stray Scanner: `imu.csv`, `odometry.csv` (ARKit's camera poses at each image)
/// and `camera_matrix.csv`.
Log read_stray_scanner(const std::filesystem::path& folder);

/// Reads `data.jsonl` of Spectacular AI, with the camera of the optional `calibration.json` beside
/// it.
Log read_spectacular(const std::filesystem::path& file);

}  // namespace gpo
