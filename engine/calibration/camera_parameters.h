// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"

#include <string>
#include <vector>

#include <fmt/format.h>

namespace gpo {

/// Names of what is calibrated of a camera, in order: "fx", ..., "k1", ...
std::vector<std::string> parameter_names(const Camera& camera);
/// Their values.
std::vector<double> parameters(const Camera& camera);

/// How many digits a file has, and who says so.
struct YamlStyle {
  int coefficient_digits = 6;
  int sigma_digits = 3;
  const char* source = "";         ///< a line
  const char* sigmas_remark = "";  ///< a line
};
/// `resolution` to `distortion_coefficients_sigma`; without a lens or sigmas where there are none.
std::string camera_yaml(const Camera& camera, const YamlStyle& style);

/// A line of what `calibrate` prints.
inline std::string row(const std::string& name, const std::string& value) {
  return fmt::format("{:<12}{}\n", name, value);
}

}  // namespace gpo
