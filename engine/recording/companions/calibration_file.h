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

/// What a calibration file knows about one camera.
struct Calibration {
  Camera camera;
  std::optional<Pose>
      T_body_camera;                ///< x_body = R_wc x_camera + p_wc; Kalibr: the body is the IMU
  std::int64_t time_offset_ns = 0;  ///< gyroscope clock = camera clock + offset
  std::optional<double> rate_hz;    ///< of the pictures
  bool self_calibrated = false;     ///< `source: self-calibrated`, without a board
};

/// Reads a camera's calibration: EuRoC's sensor.yaml, OpenCV's FileStorage (YAML, JSON, XML; also
/// ROS') or Kalibr's camchain, told apart by their keys. OpenCV's need not tell the size of the
/// pictures: width and height are 0 then. Throws InputError.
Calibration read_calibration(const std::filesystem::path& file);

/// Whether `read_calibration` takes it as a camera's `rate_hz`.
bool is_image_rate(double rate_hz);

/// As EuRoC's files call it.
const char* distortion_name(Distortion distortion);

/// The calibration in a folder, by the names that people and tools give it: camera.yaml,
/// sensor.yaml, camchain-imucam.yaml, calibration.xml, ...; nothing where there is none.
std::optional<std::filesystem::path> find_calibration(const std::filesystem::path& folder);
/// The same. Throws InputError where there is none.
std::filesystem::path calibration_in(const std::filesystem::path& folder);

/// EuRoC's `T_BS`: a list of 16 numbers, 4 x 4 lists, or {rows, cols, data}. Throws InputError
/// where it is no rigid motion.
Pose rigid_motion(const YamlEntry& entry);

}  // namespace gpo
