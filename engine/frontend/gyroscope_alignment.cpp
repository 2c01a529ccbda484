// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/gyroscope_alignment.h"

#include "engine/geometry/decompositions.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"
#include "engine/window/timestamps.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kMostOffset_s = 1;
constexpr double kOffsetStep_s = 0.005;
constexpr double kKneeInMedians = 2;  // knee of Huber's loss, in medians

/// Wahba's problem by singular values (Markley 1988), reweighted.
GyroAlignment align(const Pairs& pairs) {
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

Vector3d medians_of(const Matrix3Xd& all) {
  Vector3d middle;
  for (int axis = 0; axis < 3; ++axis) {
    const auto row = all.row(axis);
    middle[axis] = median({row.begin(), row.end()});
  }
  return middle;
}

/// Median distance of columns from their median [rad/s].
double scatter_of(const Matrix3Xd& all) {
  const Eigen::RowVectorXd norms = (all.colwise() - medians_of(all)).colwise().norm();
  return median({norms.begin(), norms.end()});
}

/// Returns rates over 0.1 s or a frame, whichever is longer; images determine these far better than
/// rates over single frames. They overlap.
std::vector<Interval> long_intervals_of(const ImageRotations& window) {
  constexpr double kSpan_ns = 1e8;
  const auto period_ns = static_cast<double>(median_period_ns(window.timestamps_ns));
  const auto span = static_cast<std::size_t>(std::max(1L, std::lround(kSpan_ns / period_ns)));
  return intervals_of({window}, span);
}

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

std::optional<GyroAlignment> best_alignment(const RateIntegral& integral,
                                            const std::vector<Interval>& intervals,
                                            double around_s) {
  std::optional<GyroAlignment> best;
  const int steps = static_cast<int>(kMostOffset_s / kOffsetStep_s);
  for (int k = -steps; k <= steps; ++k) {
    const double offset_s = around_s + k * kOffsetStep_s;
    const Pairs pairs = pairs_at(integral, intervals, offset_s);
    if (2 * pairs.images.cols() < std::ssize(intervals)) continue;
    GyroAlignment alignment = align(pairs);
    alignment.offset_s = offset_s;
    if (!best || alignment.cost < best->cost) best = alignment;
  }
  if (best && !std::isfinite(best->cost)) return std::nullopt;
  return best;
}

GyroscopeCheck check_gyroscope_against(const ImageRotations& window, const Gyroscope& gyroscope) {
  constexpr double kFarBetter = 0.35;  // scatter of the differences, relative to the recorded one
  constexpr double kLeast_rad_s = 0.001;  // smaller differences are noise of the images
  constexpr double kExplained = 0.15;     // share of the images' own scatter
  constexpr double kUnexplained = 0.75;   // by the recorded axes, share of the larger scatter
  constexpr double kStabilized = 0.55;    // scatter of the images, share of the gyroscope's
  constexpr double kLeastAxes_deg = 20, kLeastRotation_rad_s = 0.15;
  constexpr double kWindow_s = 0.2, kStep_s = 0.0025;
  if (window.R_wc.size() <= kLeastIntervals) return {};
  const std::vector<Interval> intervals = long_intervals_of(window);
  const std::int64_t margin_ns = to_ns(kWindow_s + 0.1);
  const Gyroscope samples =
      samples_between(gyroscope,
                      window.timestamps_ns.front() + gyroscope.time_offset_ns - margin_ns,
                      window.timestamps_ns.back() + gyroscope.time_offset_ns + margin_ns);
  const double recorded_s = 1e-9 * static_cast<double>(gyroscope.time_offset_ns);
  if (intervals.size() < kLeastIntervals || samples.timestamps_ns.size() < 2) return {};
  const RateIntegral integral(samples);
  const auto difference = [&](const Pairs& pairs, const Eigen::Matrix3d& R_gyro_camera) {
    return scatter_of(pairs.gyroscope - R_gyro_camera * pairs.images);
  };
  const Pairs now = pairs_at(integral, intervals, recorded_s);
  if (now.images.cols() < std::ptrdiff_t{kLeastIntervals}) return {};
  const double recorded = difference(now, gyroscope.R_gyro_camera);
  if (recorded < kLeast_rad_s) return {};
  double by_clock = recorded, late_s = 0, by_axes = recorded, apart_deg = 0;
  for (double shift_s = -kWindow_s; shift_s <= kWindow_s; shift_s += kStep_s) {
    const Pairs pairs = pairs_at(integral, intervals, recorded_s + shift_s);
    if (pairs.images.cols() < now.images.cols()) continue;
    if (const double one = difference(pairs, gyroscope.R_gyro_camera); one < by_clock) {
      by_clock = one;
      late_s = shift_s;
    }
    const Eigen::Matrix3d R = align(pairs).R;
    if (const double one = difference(pairs, R); one < by_axes) {
      by_axes = one;
      apart_deg = degrees(so3_log(R.transpose() * gyroscope.R_gyro_camera).norm());
    }
  }
  const double half_frame_s = 0.5e-9 * static_cast<double>(median_period_ns(window.timestamps_ns));
  if (by_clock < kFarBetter * recorded && std::abs(late_s) > half_frame_s)
    return {fmt::format("its clock is about {:+.0f} ms off", 1e3 * late_s), late_s};
  const double of_images = scatter_of(now.images), of_gyroscope = scatter_of(now.gyroscope);
  if (by_axes < std::min(kFarBetter * by_clock, kExplained * of_images) &&
      apart_deg > kLeastAxes_deg)
    return {fmt::format("its axes are about {:.0f} deg off", apart_deg)};
  const bool rotates = of_gyroscope > kLeastRotation_rad_s;
  if (!rotates) return {};
  if (of_images < kStabilized * of_gyroscope && by_clock > kStabilized * of_gyroscope)
    return {"the images rotate less than it does, as stabilized images do"};
  if (by_clock < kUnexplained * std::max(of_images, of_gyroscope)) return {};
  return {fmt::format("their rates have a correlation of {:.2f}", correlation_of(now))};
}

}  // namespace gpo
