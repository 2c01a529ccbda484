// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/window/gyroscope.h"
#include "engine/window/window.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Camera rotations of a window, one a frame, R_wc of its first frame is I; or why there are none.
struct Rotations {
  std::vector<Eigen::Matrix3d> R_wc = {};
  std::string reason = "";
  RotationModel model = RotationModel::known;          ///< what is uncertain of them
  std::optional<GyroSensitivity> gyro = std::nullopt;  ///< where they are a gyroscope's
  double sigma_rad = 0;                                ///< of rotations from pictures, roughly
  bool stopped = false;                                ///< there are none because of that
  std::string note = "";  ///< what told them, where that is worth a sentence
};

/// automatic: a gyroscope, calibrated where the pictures can; without one five-point rotations
/// where the scene has more than one plane, else averaging. raw: a gyroscope as it is, else
/// averaging. averaging is of decomposed homographies; five_point and direct are of all tracks.
enum class RotationSource {
  automatic,
  raw,
  gyro,
  gyro_calibrated,
  averaging,
  five_point,
  direct,
  truth
};

template <>
struct ChoiceKeys<RotationSource> {
  static constexpr const char* name = "rotations";
  static constexpr std::array keys{
      "automatic", "raw", "gyro", "gyro-calibrated", "averaging", "five-point", "direct", "truth"};
};

/// Whether the source integrates a gyroscope.
bool needs_gyroscope(RotationSource source);

/// R_wc at each of the times, world = camera at the first: mid-point integration of (w - bias) on
/// SO(3), interpolated at the frame times (engine/method.md, eq. 5). Throws InputError where
/// the samples do not cover the times or leave a gap of more than five sample periods between them.
std::vector<Eigen::Matrix3d> gyro_rotations(const Gyroscope& gyroscope,
                                            std::span<const std::int64_t> frame_times_ns);

/// The same, with how they move with the gyroscope's bias, whose prior is its own, and its clock.
Rotations sensitive_gyro_rotations(const Gyroscope& gyroscope,
                                   std::span<const std::int64_t> frame_times_ns);

}  // namespace gpo
