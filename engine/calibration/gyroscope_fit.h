// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/gyroscope.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Placement of a gyroscope relative to its camera. Standard deviations are clustered by window, as
/// all frames of a window share errors.
struct GyroscopeFit {
  bool ok = false;
  std::string reason;                                            ///< why it is not
  Eigen::Matrix3d R_gyro_camera = Eigen::Matrix3d::Identity();   ///< camera axes -> gyroscope axes
  Eigen::Vector3d rotation_sigma_deg = Eigen::Vector3d::Zero();  ///< about the camera's axes
  /// Gyroscope clock = camera clock + offset, in the middle of the recording.
  double time_offset_s = 0;
  double time_offset_sigma_s = 0;
  std::optional<double> drift;  ///< change of the offset [s/s]; nullopt below a minute
  double drift_sigma = 0;
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();  ///< gyroscope axes
  Eigen::Vector3d bias_sigma_rad_s = Eigen::Vector3d::Zero();
  double correlation = 0;  ///< between the magnitudes of the rates of gyroscope and images, -1 to 1
  double rms_before_deg = 0;  ///< rotations from a window's first frame, before the fit
  double rms_deg = 0;         ///< the same after the fit
  int windows = 0;            ///< used
  int outliers = 0;           ///< windows left out, as their images disagree
  std::vector<std::string> warnings;
};

/// Estimates the rotation between gyroscope and camera, the offset of the clocks (within a second
/// of the recording's), drift and bias. Starts on a grid of offsets, each with the rotation between
/// the rates of gyroscope and images (Wahba's problem, for any naming of the axes), and then
/// minimizes a robust loss over the rotations of all windows. Warns if mirrored axes would fit far
/// better.
GyroscopeFit fit_gyroscope(const std::vector<ImageRotations>& windows, const Gyroscope& gyroscope);

std::int64_t to_ns(double seconds);

/// Integrals of the gyroscope's rates from its first sample on, linear between samples, so that the
/// mean rate over a span is a difference.
class RateIntegral {
 public:
  explicit RateIntegral(const Gyroscope& gyroscope);
  /// Mean rate on the gyroscope's clock; nullopt outside of the samples.
  std::optional<Eigen::Vector3d> mean_rate(std::int64_t from_ns, std::int64_t to_ns) const;

 private:
  std::optional<Eigen::Vector3d> at(std::int64_t time_ns) const;

  const std::vector<std::int64_t>& times_ns_;
  std::vector<Eigen::Vector3d> sums_;
};

/// Angular rate between two frames by their images.
struct Interval {
  std::int64_t from_ns, to_ns;
  Eigen::Vector3d rate_rad_s;  ///< camera axes
};

std::vector<Interval> intervals_of(const std::vector<ImageRotations>& windows);

/// Rates of gyroscope and images over the same spans.
struct Pairs {
  Eigen::Matrix3Xd gyroscope, images;
};

/// Pairs all intervals that the samples cover.
Pairs pairs_at(const RateIntegral& integral,
               const std::vector<Interval>& intervals,
               double offset_s);

/// Correlation of the magnitudes of the rates.
double correlation_of(const Pairs& pairs);

/// Solution of `gyroscope = R pictures + bias` at an offset of the clocks by weighted least
/// squares.
struct GyroAlignment {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  double offset_s = 0;
  double cost = std::numeric_limits<double>::infinity();  ///< mean of the loss [(rad/s)^2]
};

inline constexpr std::size_t kLeastIntervals = 12;

/// The best alignment on a grid of offsets that cover half of the intervals; nullopt if none does.
std::optional<GyroAlignment> best_alignment(const RateIntegral& integral,
                                            const std::vector<Interval>& intervals,
                                            double around_s);

}  // namespace gpo
