// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/euroc_text.h"

#include "engine/recording/companions/companion_files.h"

#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {

std::string cells(const Eigen::Ref<const Eigen::VectorXd>& values, std::optional<int> decimals) {
  std::string text;
  for (const double value : values)
    text += decimals ? fmt::format(",{:.{}f}", value, *decimals) : fmt::format(",{}", value);
  return text;
}

std::string quaternion_cells(const Eigen::Quaterniond& q, std::optional<int> decimals) {
  return cells(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()), decimals);
}

Eigen::Quaterniond SteadyQuaternions::operator()(const Eigen::Matrix3d& R) {
  Eigen::Quaterniond q(R);
  if (q.dot(previous_) < 0) q.coeffs() *= -1;
  previous_ = q;
  return q;
}

std::string yaml_list(std::span<const double> values) {
  return fmt::format("[{}]", fmt::join(values, ", "));
}

std::string yaml_list(const Eigen::Vector3d& values) {
  return yaml_list(std::span(values.data(), 3));
}

std::string transformation_yaml(const Pose& pose) {
  std::string rows;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Matrix3d& R = pose.R_wc;
    rows += fmt::format("         {}, {}, {}, {},\n", R(i, 0), R(i, 1), R(i, 2), pose.p_wc[i]);
  }
  return fmt::format("T_BS:\n  cols: 4\n  rows: 4\n  data: [\n{}         0, 0, 0, 1]\n", rows);
}

std::string bias_yaml(const Gyroscope& gyroscope) {
  std::string text;
  if (!gyroscope.bias_rad_s.isZero(0))
    text = fmt::format("gyroscope_bias: {}  # [rad/s]\n", yaml_list(gyroscope.bias_rad_s));
  return text + fmt::format(
                    "gyroscope_bias_sigma: {}  # [rad/s]\n"
                    "gyroscope_noise_density: {}  # [rad/s/sqrt(Hz)]\n",
                    gyroscope.bias_sigma_rad_s,
                    gyroscope.noise_density);
}

std::string lens_yaml(const Camera& camera) {
  return fmt::format(
      "resolution: [{}, {}]\ncamera_model: pinhole\nintrinsics: {}  # fx, fy, cx, cy\n"
      "distortion_model: {}\ndistortion_coefficients: {}\n",
      camera.width,
      camera.height,
      yaml_list(std::array{camera.fx, camera.fy, camera.cx, camera.cy}),
      distortion_name(camera.distortion),
      yaml_list(camera.coefficients));
}

}  // namespace gpo
