// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/gyroscope.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

std::int64_t to_ns(double seconds);

/// Integrals of the gyroscope's rates, from its first sample on; linear between samples, so that
/// the mean rate over any span is a difference.
class RateIntegral {
 public:
  explicit RateIntegral(const Gyroscope& gyroscope) : times_ns_(gyroscope.timestamps_ns) {
    sums_.push_back(Eigen::Vector3d::Zero());
    for (std::size_t k = 1; k < times_ns_.size(); ++k) {
      const double dt_s = 1e-9 * static_cast<double>(times_ns_[k] - times_ns_[k - 1]);
      sums_.emplace_back(sums_.back() +
                         0.5 * dt_s * (gyroscope.rates_rad_s[k - 1] + gyroscope.rates_rad_s[k]));
    }
  }
  /// Nothing outside of the samples. Gyroscope clock.
  std::optional<Eigen::Vector3d> mean_rate(std::int64_t from_ns, std::int64_t to_ns) const {
    const auto from = at(from_ns);
    const auto to = at(to_ns);
    if (!from || !to || to_ns <= from_ns) return std::nullopt;
    return Eigen::Vector3d((*to - *from) / (1e-9 * static_cast<double>(to_ns - from_ns)));
  }

 private:
  std::optional<Eigen::Vector3d> at(std::int64_t time_ns) const {
    const auto after = std::ranges::upper_bound(times_ns_, time_ns);
    if (after == times_ns_.begin() || after == times_ns_.end()) return std::nullopt;
    const auto k = static_cast<std::size_t>(after - times_ns_.begin());
    const double share = static_cast<double>(time_ns - times_ns_[k - 1]) /
                         static_cast<double>(times_ns_[k] - times_ns_[k - 1]);
    return Eigen::Vector3d(sums_[k - 1] + share * (sums_[k] - sums_[k - 1]));
  }

  const std::vector<std::int64_t>& times_ns_;
  std::vector<Eigen::Vector3d> sums_;
};

/// What the pictures say between two frames.
struct Interval {
  std::int64_t from_ns, to_ns;
  Eigen::Vector3d rate_rad_s;  ///< camera axes
};

std::vector<Interval> intervals_of(const std::vector<ImageRotations>& windows);

/// Rates of gyroscope and pictures over the same spans.
struct Pairs {
  std::vector<Eigen::Vector3d> gyroscope;
  std::vector<Eigen::Vector3d> images;
};

/// Without the intervals that the samples do not cover.
Pairs pairs_at(const RateIntegral& integral,
               const std::vector<Interval>& intervals,
               double offset_s);

/// Of their speeds.
double correlation_of(const Pairs& pairs);

/// gyroscope = R pictures + bias, weighted.
struct GyroAlignment {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  std::vector<double> errors_rad_s;
  double cost = std::numeric_limits<double>::infinity();  ///< mean of the loss [(rad/s)^2]
};

struct GyroscopeStart {
  double offset_s = 0;
  GyroAlignment alignment;
};

inline constexpr std::size_t kLeastIntervals = 12;

/// The best of all offsets of which at least half of the intervals are covered; nothing: none.
std::optional<GyroscopeStart> best_start(const RateIntegral& integral,
                                         const std::vector<Interval>& intervals,
                                         double around_s);

}  // namespace gpo
