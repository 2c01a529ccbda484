// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/gyro_bias.h"

#include "engine/geometry/pose.h"

#include <fmt/format.h>

namespace gpo {
namespace {

/// Largest plausible gyroscope bias, absolute and relative to its prior.
constexpr double kMostBias_rad_s = 0.5;
constexpr double kMostBiasSigmas = 6;

}  // namespace

Window with_exact_clock(Window window) {
  window.gyro->time_offset_sigma_s = 0;
  return window;
}

std::optional<Window> with_prior_bias(const Window& window) {
  if (window.rotations != RotationModel::bias) return std::nullopt;
  const GyroSensitivity& gyro = *window.gyro;
  if (gyro.bias_rad_s == gyro.prior_rad_s) return std::nullopt;
  Window raw = window;
  PlaneMotion prior;
  prior.bias_rad_s = gyro.prior_rad_s;
  for (int i = 0; i < window.frame_count(); ++i)
    raw.R_wc[i] = window.R_wc[i] * so3_exp(gyro_correction_rad(window, i, prior));
  return raw;
}

std::string why_implausible_bias(const Window& window, const PlaneMotion& motion) {
  if (window.rotations != RotationModel::bias) return "";
  const GyroSensitivity& gyro = *window.gyro;
  const double bias_rad_s = motion.bias_rad_s.norm();
  if (bias_rad_s > kMostBias_rad_s)
    return fmt::format("wrong minimum: estimated gyroscope bias {:.2f} rad/s", bias_rad_s);
  const double sigmas = (motion.bias_rad_s - gyro.prior_rad_s).norm() / gyro.prior_sigma_rad_s;
  if (sigmas < kMostBiasSigmas) return "";
  return fmt::format(
      "wrong minimum: estimated gyroscope bias {:.3f} rad/s, {:.0f} standard deviations from its "
      "prior",
      bias_rad_s,
      sigmas);
}

}  // namespace gpo
