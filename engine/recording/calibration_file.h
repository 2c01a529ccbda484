// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "engine/recording/yaml_entry.h"

#include <cstdint>
#include <filesystem>
#include <optional>

namespace gpo {

/// What a calibration file knows about one camera.
struct Calibration {
  Camera camera;
  std::optional<Pose>
      T_body_camera;                ///< x_body = R_wc x_camera + p_wc; Kalibr: the body is the IMU
  std::int64_t time_offset_ns = 0;  ///< gyroscope clock = camera clock + offset
  std::optional<double> rate_hz;    ///< of the pictures
};

/// Reads a camera's calibration: EuRoC's sensor.yaml, OpenCV's YAML (also ROS') or Kalibr's
/// camchain, told apart by their keys. Throws InputError.
Calibration read_calibration(const std::filesystem::path& file);

/// EuRoC's `T_BS`: a list of 16 numbers, 4 x 4 lists, or {rows, cols, data}. Throws InputError
/// where it is no rigid motion.
Pose rigid_motion(const YamlEntry& entry);

}  // namespace gpo
