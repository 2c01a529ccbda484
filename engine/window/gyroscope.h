// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A gyroscope's samples, strictly ascending in time, all finite.
struct Gyroscope {
  std::filesystem::path file;
  std::vector<std::int64_t> timestamps_ns;
  std::vector<int> lines;                    ///< of each sample in `file`, for messages about a gap
  std::vector<Eigen::Vector3d> rates_rad_s;  ///< in the gyroscope's own axes
  std::vector<Eigen::Vector3d>
      accelerations_m_s2;  ///< as many, or none: specific force; tells gravity and meters
  Eigen::Matrix3d R_gyro_camera = Eigen::Matrix3d::Identity();  ///< camera axes -> gyroscope axes
  std::int64_t time_offset_ns = 0;  ///< gyroscope clock = camera clock + offset
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();
  double bias_sigma_rad_s = 0.1;           ///< each axis; by default as bad as MEMS sensors come
  double noise_density = 3e-4;             ///< of the rates, white [rad/s/sqrt(Hz)]; a phone's
  bool bias_known = false;                 ///< a file says it
  std::string bias_source = "none: zero";  ///< where the bias comes from, for people
};

}  // namespace gpo
