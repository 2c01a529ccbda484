// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/camera_parameters.h"

#include <array>
#include <span>

#include <fmt/format.h>

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

std::string camera_yaml(const Camera& camera, const YamlStyle& style) {
  const auto list = [](std::span<const double> values, int digits) {
    std::string text;
    for (const double value : values)
      text += fmt::format("{}{:.{}g}", text.empty() ? "" : ", ", value, digits);
    return fmt::format("[{}]", text);
  };
  const std::vector<double> all = parameters(camera);
  const std::span<const double> values = all, sigmas = camera.sigmas;
  std::string text = fmt::format(
      "resolution: [{}, {}]\ncamera_model: pinhole\n{}intrinsics: {}  # fx, fy, cx, cy\n",
      camera.width,
      camera.height,
      style.source,
      list(values.first(4), 8));
  if (camera.distortion != Distortion::none)
    text += fmt::format(
        "distortion_model: {}\ndistortion_coefficients: {}\n",
        camera.distortion == Distortion::equidistant ? "equidistant" : "radial-tangential",
        list(values.subspan(4), style.coefficient_digits));
  if (sigmas.size() != values.size()) return text;
  text += fmt::format(
      "{}intrinsics_sigma: {}\n", style.sigmas_remark, list(sigmas.first(4), style.sigma_digits));
  if (values.size() > 4)
    text += fmt::format("distortion_coefficients_sigma: {}\n",
                        list(sigmas.subspan(4), style.sigma_digits));
  return text;
}

}  // namespace gpo
