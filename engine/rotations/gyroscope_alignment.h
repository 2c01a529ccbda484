// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/gyroscope.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

std::int64_t to_ns(double seconds);

/// Returns the rates from `first_ns` to `last_ns` on the gyroscope's clock, as integrals over long
/// recordings take time.
Gyroscope samples_between(const Gyroscope& gyroscope, std::int64_t first_ns, std::int64_t last_ns);

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

/// Returns the rates from each frame of each window to the `frames`-th after it.
std::vector<Interval> intervals_of(const std::vector<ImageRotations>& windows,
                                   std::size_t frames = 1);

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

/// Solution of `gyroscope = R images + bias` at an offset of the clocks by weighted least
/// squares.
struct GyroAlignment {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  double offset_s = 0;
  double cost = std::numeric_limits<double>::infinity();  ///< mean of the loss [(rad/s)^2]
};

inline constexpr std::size_t kLeastIntervals = 12;

/// Solves Wahba's problem by singular values (Markley 1988), reweighted. The cost of fewer than
/// `kLeastIntervals` pairs is infinite.
GyroAlignment aligned(const Pairs& pairs);

/// The best alignment on a grid of offsets that cover half of the intervals; nullopt if none does.
std::optional<GyroAlignment> best_alignment(const RateIntegral& integral,
                                            const std::vector<Interval>& intervals,
                                            double around_s);

}  // namespace gpo
