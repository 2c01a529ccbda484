// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rotations/gyroscope_alignment.h"

#include "engine/geometry/decompositions.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kMostOffset_s = 1;
constexpr double kOffsetStep_s = 0.005;
constexpr double kKneeInMedians = 2;  // knee of Huber's loss, in medians

}  // namespace

std::int64_t to_ns(double seconds) {
  return static_cast<std::int64_t>(std::llround(1e9 * seconds));
}

Gyroscope samples_between(const Gyroscope& gyroscope, std::int64_t first_ns, std::int64_t last_ns) {
  const auto& times = gyroscope.timestamps_ns;
  const auto from = std::ranges::lower_bound(times, first_ns);
  const auto to = std::ranges::upper_bound(times, last_ns);
  Gyroscope part;
  part.timestamps_ns.assign(from, to);
  part.rates_rad_s.assign(gyroscope.rates_rad_s.begin() + (from - times.begin()),
                          gyroscope.rates_rad_s.begin() + (to - times.begin()));
  return part;
}

RateIntegral::RateIntegral(const Gyroscope& gyroscope)
    : times_ns_(gyroscope.timestamps_ns), sums_{Vector3d::Zero()} {
  for (std::size_t k = 1; k < times_ns_.size(); ++k) {
    const double dt_s = 1e-9 * static_cast<double>(times_ns_[k] - times_ns_[k - 1]);
    sums_.emplace_back(sums_.back() +
                       0.5 * dt_s * (gyroscope.rates_rad_s[k - 1] + gyroscope.rates_rad_s[k]));
  }
}

std::optional<Vector3d> RateIntegral::mean_rate(std::int64_t from_ns, std::int64_t to_ns) const {
  const auto from = at(from_ns);
  const auto to = at(to_ns);
  if (!from || !to || to_ns <= from_ns) return std::nullopt;
  return Vector3d((*to - *from) / (1e-9 * static_cast<double>(to_ns - from_ns)));
}

std::optional<Vector3d> RateIntegral::at(std::int64_t time_ns) const {
  const auto after = std::ranges::upper_bound(times_ns_, time_ns);
  if (times_ns_.empty() || time_ns < times_ns_.front() || time_ns > times_ns_.back())
    return std::nullopt;
  if (after == times_ns_.end()) return sums_.back();
  const auto k = static_cast<std::size_t>(after - times_ns_.begin());
  const double share = static_cast<double>(time_ns - times_ns_[k - 1]) /
                       static_cast<double>(times_ns_[k] - times_ns_[k - 1]);
  return Vector3d(sums_[k - 1] + share * (sums_[k] - sums_[k - 1]));
}

std::vector<Interval> intervals_of(const std::vector<ImageRotations>& windows, std::size_t frames) {
  std::vector<Interval> all;
  for (const ImageRotations& window : windows) {
    for (std::size_t i = frames; i < window.R_wc.size(); ++i) {
      const std::int64_t from_ns = window.timestamps_ns[i - frames];
      const std::int64_t to_ns = window.timestamps_ns[i];
      const Vector3d rotation = so3_log(window.R_wc[i - frames].transpose() * window.R_wc[i]);
      all.push_back({from_ns, to_ns, rotation / (1e-9 * static_cast<double>(to_ns - from_ns))});
    }
  }
  return all;
}

Pairs pairs_at(const RateIntegral& integral,
               const std::vector<Interval>& intervals,
               double offset_s) {
  const std::int64_t offset_ns = to_ns(offset_s);
  Pairs pairs{Matrix3Xd(3, std::ssize(intervals)), Matrix3Xd(3, std::ssize(intervals))};
  Eigen::Index count = 0;
  for (const Interval& one : intervals) {
    const auto rate = integral.mean_rate(one.from_ns + offset_ns, one.to_ns + offset_ns);
    if (!rate) continue;
    pairs.gyroscope.col(count) = *rate;
    pairs.images.col(count++) = one.rate_rad_s;
  }
  pairs.gyroscope.conservativeResize(3, count);
  pairs.images.conservativeResize(3, count);
  return pairs;
}

double correlation_of(const Pairs& pairs) {
  Eigen::ArrayXd x = pairs.gyroscope.colwise().norm().transpose();
  Eigen::ArrayXd y = pairs.images.colwise().norm().transpose();
  x -= x.mean();
  y -= y.mean();
  return (x * y).sum() / std::sqrt(std::max(1e-300, x.square().sum() * y.square().sum()));
}

GyroAlignment aligned(const Pairs& pairs) {
  const auto& [gyroscope, images] = pairs;
  GyroAlignment result;
  if (images.cols() < std::ptrdiff_t{kLeastIntervals}) return result;
  Eigen::ArrayXd weights = Eigen::ArrayXd::Ones(images.cols());
  for (int round = 0; round < 6; ++round) {
    const Eigen::VectorXd shares = weights / weights.sum();
    const Vector3d mean_g = gyroscope * shares, mean_p = images * shares;
    result.R = nearest_rotation((gyroscope.colwise() - mean_g) * weights.matrix().asDiagonal() *
                                (images.colwise() - mean_p).transpose());
    result.bias = mean_g - result.R * mean_p;
    const Matrix3Xd errors = (gyroscope - result.R * images).colwise() - result.bias;
    const Eigen::ArrayXd e = errors.colwise().norm().transpose();
    const double knee = std::max(1e-6, kKneeInMedians * median({e.begin(), e.end()}));
    weights = (e < knee).select(1.0, knee / e);
    result.cost = (e < knee).select(0.5 * e.square(), knee * (e - 0.5 * knee)).mean();
  }
  return result;
}

std::optional<GyroAlignment> best_alignment(const RateIntegral& integral,
                                            const std::vector<Interval>& intervals,
                                            double around_s) {
  std::optional<GyroAlignment> best;
  const int steps = static_cast<int>(kMostOffset_s / kOffsetStep_s);
  for (int k = -steps; k <= steps; ++k) {
    const double offset_s = around_s + k * kOffsetStep_s;
    const Pairs pairs = pairs_at(integral, intervals, offset_s);
    if (2 * pairs.images.cols() < std::ssize(intervals)) continue;
    GyroAlignment alignment = aligned(pairs);
    alignment.offset_s = offset_s;
    if (!best || alignment.cost < best->cost) best = alignment;
  }
  if (best && !std::isfinite(best->cost)) return std::nullopt;
  return best;
}

}  // namespace gpo
