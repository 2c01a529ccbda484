// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/plane_views/gyro_rotations.h"

#include "engine/frontend/rotations.h"
#include "engine/geometry/pose.h"

#include <array>
#include <cmath>

namespace gpo {
namespace {

// Of a phone's: what its noise leaves of a turn, and by how much its rates are too high or too low.
constexpr double kNoise_rad = 3e-4;
constexpr double kScale = 3e-3;

}  // namespace

GyroRotations gyro_rotations(const Gyroscope& gyroscope,
                     std::span<const std::int64_t> frame_times_ns,
                     const std::vector<ObservedPlane>& planes) {
  GyroRotations gyro;
  gyro.bias_sigma_rad_s = gyroscope.bias_sigma_rad_s;
  for (const ObservedPlane& plane : planes) {
    for (std::size_t i = 1; i < plane.views.size(); ++i) {
      const int from = plane.views[i - 1].frame;
      const int to = plane.views[i].frame;
      const std::array times{frame_times_ns[from], frame_times_ns[to]};
      const std::int64_t offset_ns = gyroscope.time_offset_ns;
      if (!why_not_covered(gyroscope, times[0] + offset_ns, times[1] + offset_ns).empty()) continue;
      const Rotations rotation = sensitive_gyro_rotations(gyroscope, times);
      const double sigma_rad = std::hypot(kNoise_rad, kScale * so3_log(rotation.R_wc[1]).norm());
      gyro.rotations.push_back({from, to, rotation.R_wc[1], rotation.gyro->d_bias[1], sigma_rad});
    }
  }
  return gyro;
}

}  // namespace gpo
