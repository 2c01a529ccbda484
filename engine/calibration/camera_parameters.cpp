// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/camera_parameters.h"

#include <array>
#include <span>

namespace gpo {

std::vector<std::string> parameter_names(const Camera& camera) {
  static constexpr std::array equidistant{"fx", "fy", "cx", "cy", "k1", "k2", "k3", "k4"};
  static constexpr std::array radial_tangential{
      "fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
  const std::span<const char* const> all = camera.distortion == Distortion::equidistant
                                               ? std::span<const char* const>(equidistant)
                                               : std::span<const char* const>(radial_tangential);
  const auto own = all.first(4 + camera.coefficients.size());
  return {own.begin(), own.end()};
}

std::vector<double> parameters(const Camera& camera) {
  std::vector<double> values = {camera.fx, camera.fy, camera.cx, camera.cy};
  values.insert(values.end(), camera.coefficients.begin(), camera.coefficients.end());
  return values;
}

}  // namespace gpo
