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

inline constexpr double kUnknownBiasSigma_rad_s = 0.1;  ///< each axis, of a poor MEMS sensor

/// Gyroscope samples, strictly ascending in time, all finite.
struct Gyroscope {
  std::filesystem::path file;
  std::vector<std::int64_t> timestamps_ns;
  std::vector<int> lines;                    ///< line of each sample in `file`, for error messages
  std::vector<Eigen::Vector3d> rates_rad_s;  ///< in the gyroscope's axes
  std::vector<Eigen::Vector3d> accelerations_m_s2;  ///< specific force, one per sample, or empty
  Eigen::Matrix3d R_gyro_camera = Eigen::Matrix3d::Identity();  ///< camera axes -> gyroscope axes
  std::int64_t time_offset_ns = 0;  ///< gyroscope clock = camera clock + offset
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();
  double bias_sigma_rad_s = kUnknownBiasSigma_rad_s;  ///< each axis
  double noise_density = 3e-4;  ///< white noise [rad/s/sqrt(Hz)]; default: a phone
  int left_out = 0;             ///< samples of the file that are not finite or repeat a time
  bool bias_known = false;      ///< read from a file
  std::string bias_source = "none: zero";  ///< for people
};

/// Standard deviation of a bias that a file states without one, each axis [rad/s]: the drift of a
/// phone's gyroscope over ten kelvins (data sheet of LSM6DSO: 0.01 deg/s per kelvin).
inline constexpr double kStatedBiasSigma_rad_s = 0.002;

/// Standard deviation of the offset between the clocks of camera and gyroscope [s]. Logs of phones
/// are late by up to a frame, and a calibration holds for one recording.
inline constexpr double kTimeOffsetSigma_s = 0.02;

/// Returns the standard deviation of `bias_rad_s` where rotations are held, each axis. A bias that
/// is stated without one has `kStatedBiasSigma_rad_s`.
double held_bias_sigma_rad_s(const Gyroscope& gyroscope);

/// Rotations of one window estimated from its images.
struct ImageRotations {
  std::vector<std::int64_t> timestamps_ns;  ///< camera clock, ascending, at least two
  std::vector<Eigen::Matrix3d> R_wc;        ///< one per frame, the first one is I
};

/// Measurement of gyroscope and accelerometer at one time.
struct InertialSample {
  Eigen::Vector3d rate_rad_s;
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();  ///< zero without accelerometer
};

/// Returns the index of the first sample after a time. All times are on the gyroscope's clock.
std::size_t first_after(const Gyroscope& gyroscope, std::int64_t t_ns);

/// Returns why the samples do not cover the time span; empty if they do. They fail if they begin
/// late or end early by more than 1.5 periods, have a gap of more than five, or are out of order.
std::string why_not_covered(const Gyroscope& gyroscope,
                            std::int64_t first_ns,
                            std::int64_t last_ns);

/// Returns the measurement at a time, interpolated linearly, constant beyond the ends.
InertialSample sample_at(const Gyroscope& gyroscope, std::int64_t t_ns);

/// Integrates by the mid-point rule: calls `advance` for the step to each sample between `from_ns`
/// and `to_ns` and for the last step, with its mean measurement and length [s].
void integrate(const Gyroscope& gyroscope,
               std::int64_t from_ns,
               std::int64_t to_ns,
               const std::function<void(const InertialSample& mean, double dt_s)>& advance);

}  // namespace gpo
