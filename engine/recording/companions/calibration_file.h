// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/yaml_entry.h"
#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"

#include <cstdint>
#include <filesystem>
#include <optional>

namespace gpo {

/// One camera's calibration.
struct Calibration {
  Camera camera;
  /// x_body = R_wc x_camera + p_wc; with Kalibr the body is the IMU.
  std::optional<Pose> T_body_camera;
  std::int64_t time_offset_ns = 0;  ///< gyroscope clock = camera clock + offset
  std::optional<double> rate_hz;    ///< of the images
  bool self_calibrated = false;     ///< `source: self-calibrated`, without a board
};

/// Reads EuRoC's sensor.yaml, OpenCV's FileStorage (YAML, JSON, XML; also ROS') or Kalibr's
/// camchain, distinguished by their keys. Width and height are 0 if OpenCV's file lacks them.
/// Throws InputError.
Calibration read_calibration(const std::filesystem::path& file);

/// Whether `read_calibration` accepts it as a camera's `rate_hz`.
bool is_image_rate(double rate_hz);

/// Name in EuRoC's files.
const char* distortion_name(Distortion distortion);

/// Returns the calibration file in a folder, by its usual names: camera.yaml, sensor.yaml,
/// camchain-imucam.yaml, calibration.xml, ...; nullopt if there is none.
std::optional<std::filesystem::path> find_calibration(const std::filesystem::path& folder);
/// The same. Throws InputError if there is none.
std::filesystem::path calibration_in(const std::filesystem::path& folder);

/// Reads EuRoC's `T_BS`: a list of 16 numbers, 4 x 4 lists, or {rows, cols, data}. Throws
/// InputError unless it is a rigid motion.
Pose rigid_motion(const YamlEntry& entry);

}  // namespace gpo
