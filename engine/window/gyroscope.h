// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
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

/// What a gyroscope and its accelerometer measure at a time.
struct InertialSample {
  Eigen::Vector3d rate_rad_s;
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();  ///< zero without accelerations
};

/// Index of the first sample after a time. All times here are on the gyroscope's clock.
std::size_t first_after(const Gyroscope& gyroscope, std::int64_t t_ns);

/// Why the samples do not cover the span closely: they begin later or end earlier by more than 1.5
/// periods, leave a gap of more than five, or are out of order. Empty if they cover it.
std::string why_not_covered(const Gyroscope& gyroscope,
                            std::int64_t first_ns,
                            std::int64_t last_ns);

/// The measurement at a time, linear between samples, held beyond them.
InertialSample sample_at(const Gyroscope& gyroscope, std::int64_t t_ns);

/// Integrates from one time to another by the mid-point rule: calls `advance` for the step to each
/// sample between and to the end, with the step's mean measurement and length [s].
void integrate(const Gyroscope& gyroscope,
               std::int64_t from_ns,
               std::int64_t to_ns,
               const std::function<void(const InertialSample& mean, double dt_s)>& advance);

}  // namespace gpo
