// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/gyroscope_alignment.h"

#include "engine/geometry/nearest_rotation.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kMostOffset_s = 1;
constexpr double kOffsetStep_s = 0.005;
constexpr double kKneeInMedians = 2;  // knee of Huber's loss, in medians

/// Wahba's problem by singular values (Markley 1988), reweighted.
GyroAlignment align(const Pairs& pairs) {
  const std::size_t n = pairs.images.size();
  GyroAlignment result;
  if (n < kLeastIntervals) return result;
  std::vector<double> weights(n, 1), errors_rad_s(n);
  for (int round = 0; round < 6; ++round) {
    Vector3d mean_g = Vector3d::Zero(), mean_p = Vector3d::Zero();
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) {
      mean_g += weights[k] * pairs.gyroscope[k];
      mean_p += weights[k] * pairs.images[k];
      sum += weights[k];
    }
    mean_g /= sum;
    mean_p /= sum;
    Matrix3d B = Matrix3d::Zero();
    for (std::size_t k = 0; k < n; ++k)
      B += weights[k] * (pairs.gyroscope[k] - mean_g) * (pairs.images[k] - mean_p).transpose();
    result.R = nearest_rotation(B);
    result.bias = mean_g - result.R * mean_p;
    for (std::size_t k = 0; k < n; ++k)
      errors_rad_s[k] = (pairs.gyroscope[k] - result.R * pairs.images[k] - result.bias).norm();
    const double knee = std::max(1e-6, kKneeInMedians * median(errors_rad_s));
    result.cost = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double e = errors_rad_s[k];
      weights[k] = e < knee ? 1 : knee / e;
      result.cost += (e < knee ? 0.5 * e * e : knee * (e - 0.5 * knee)) / static_cast<double>(n);
    }
  }
  return result;
}

}  // namespace

std::int64_t to_ns(double seconds) {
  return static_cast<std::int64_t>(std::llround(1e9 * seconds));
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
  if (after == times_ns_.begin() || after == times_ns_.end()) return std::nullopt;
  const auto k = static_cast<std::size_t>(after - times_ns_.begin());
  const double share = static_cast<double>(time_ns - times_ns_[k - 1]) /
                       static_cast<double>(times_ns_[k] - times_ns_[k - 1]);
  return Vector3d(sums_[k - 1] + share * (sums_[k] - sums_[k - 1]));
}

std::vector<Interval> intervals_of(const std::vector<ImageRotations>& windows) {
  std::vector<Interval> all;
  for (const ImageRotations& window : windows) {
    for (std::size_t i = 1; i < window.R_wc.size(); ++i) {
      const std::int64_t from_ns = window.timestamps_ns[i - 1];
      const std::int64_t to_ns = window.timestamps_ns[i];
      const Vector3d rotation = so3_log(window.R_wc[i - 1].transpose() * window.R_wc[i]);
      all.push_back({from_ns, to_ns, rotation / (1e-9 * static_cast<double>(to_ns - from_ns))});
    }
  }
  return all;
}

Pairs pairs_at(const RateIntegral& integral,
               const std::vector<Interval>& intervals,
               double offset_s) {
  Pairs pairs;
  const std::int64_t offset_ns = to_ns(offset_s);
  for (const Interval& one : intervals) {
    const auto rate = integral.mean_rate(one.from_ns + offset_ns, one.to_ns + offset_ns);
    if (!rate) continue;
    pairs.gyroscope.push_back(*rate);
    pairs.images.push_back(one.rate_rad_s);
  }
  return pairs;
}

double correlation_of(const Pairs& pairs) {
  const auto n = std::ssize(pairs.images);
  Eigen::ArrayXd x(n), y(n);
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    x[k] = pairs.gyroscope[k].norm();
    y[k] = pairs.images[k].norm();
  }
  x -= x.mean();
  y -= y.mean();
  return (x * y).sum() / std::sqrt(std::max(1e-300, x.square().sum() * y.square().sum()));
}

std::optional<GyroAlignment> best_alignment(const RateIntegral& integral,
                                            const std::vector<Interval>& intervals,
                                            double around_s) {
  std::optional<GyroAlignment> best;
  const int steps = static_cast<int>(kMostOffset_s / kOffsetStep_s);
  for (int k = -steps; k <= steps; ++k) {
    const double offset_s = around_s + k * kOffsetStep_s;
    const Pairs pairs = pairs_at(integral, intervals, offset_s);
    if (2 * pairs.images.size() < intervals.size()) continue;
    GyroAlignment alignment = align(pairs);
    alignment.offset_s = offset_s;
    if (!best || alignment.cost < best->cost) best = alignment;
  }
  if (best && !std::isfinite(best->cost)) return std::nullopt;
  return best;
}

}  // namespace gpo
