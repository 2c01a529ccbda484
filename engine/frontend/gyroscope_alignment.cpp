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

double difference(const Pairs& pairs, const Eigen::Matrix3d& R_gyro_camera) {
  return scatter_of(pairs.gyroscope - R_gyro_camera * pairs.images);
}

constexpr double kSpan_s = 0.1;  // images determine rates over it far better than over frames
constexpr int kSteps = 80;       // offsets of the clock that are tried, in both directions
constexpr double kStep_s = 0.0025, kWindow_s = kSteps * kStep_s;
constexpr double kFarBetter = 0.35;  // scatter of the differences, relative to the recorded one

/// Scatter of the differences by the best other clock and by the best other axes [rad/s].
struct Alternatives {
  double by_clock, by_axes;
  double late_s = 0, apart_deg = 0;
};

Alternatives alternatives_to(double recorded,
                             const RateIntegral& integral,
                             const std::vector<Interval>& intervals,
                             const GyroAlignment& given) {
  Alternatives best{recorded, recorded};
  const auto covered = pairs_at(integral, intervals, given.offset_s).images.cols();
  for (int step = -kSteps; step <= kSteps; ++step) {
    const double shift_s = step * kStep_s;
    const Pairs pairs = pairs_at(integral, intervals, given.offset_s + shift_s);
    if (pairs.images.cols() < covered) continue;
    if (const double one = difference(pairs, given.R); one < best.by_clock) {
      best.by_clock = one;
      best.late_s = shift_s;
    }
    const Eigen::Matrix3d R = align(pairs).R;
    if (const double one = difference(pairs, R); one < best.by_axes) {
      best.by_axes = one;
      best.apart_deg = degrees(so3_log(R.transpose() * given.R).norm());
    }
  }
  return best;
}

/// Returns how the sizes of the rates contradict each other; empty if they do not.
std::string misfit_of_size(const Pairs& now,
                           const Eigen::Matrix3d& R_gyro_camera,
                           double by_clock,
                           double sigma_rad) {
  constexpr double kUnexplained = 0.75;  // by the recorded axes, share of the larger scatter
  constexpr double kStabilized = 0.55;   // scatter of the images, share of the gyroscope's
  constexpr double kLeastRotation_rad_s = 0.15;
  // In 140 windows of real recordings, a gyroscope that fits has a share of 0.5 and more, or the
  // images' error is 0.8 of their rotation and more.
  constexpr double kHardly = 0.25;  // scatter of the gyroscope, share of the images'
  constexpr double kHalf = 0.62, kBetter = 0.5;
  constexpr double kLeastImages_rad_s = 0.05, kMostError = 0.5;
  const double of_images = scatter_of(now.images), of_gyroscope = scatter_of(now.gyroscope);
  const double share = of_gyroscope / of_images;
  const bool images_rotate = of_images > kLeastImages_rad_s;
  if (images_rotate && share < kHardly && sigma_rad < kMostError * kSpan_s * of_images)
    return "the images rotate, but it hardly does";
  if (images_rotate && share < kHalf &&
      difference({now.gyroscope / share, now.images}, R_gyro_camera) < kBetter * by_clock)
    return fmt::format("its rates are about {:.2f} of those of the images", share);
  if (of_gyroscope <= kLeastRotation_rad_s) return "";
  if (of_images < kStabilized * of_gyroscope && by_clock > kStabilized * of_gyroscope)
    return "the images rotate less than it does, as stabilized images do";
  if (by_clock < kUnexplained * std::max(of_images, of_gyroscope)) return "";
  return fmt::format("their rates have a correlation of {:.2f}", correlation_of(now));
}

/// Returns rates over 0.1 s or a frame, whichever is longer; they overlap.
std::vector<Interval> long_intervals_of(const ImageRotations& window) {
  const double period_s = 1e-9 * static_cast<double>(median_period_ns(window.timestamps_ns));
  const auto span = static_cast<std::size_t>(std::max(1L, std::lround(kSpan_s / period_s)));
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

GyroscopeCheck check_gyroscope_against(const ImageRotations& window,
                                       const Gyroscope& gyroscope,
                                       double sigma_rad) {
  constexpr double kLeast_rad_s = 0.001;  // smaller differences are noise of the images
  constexpr double kExplained = 0.15;     // share of the images' own scatter
  constexpr double kLeastAxes_deg = 20;
  if (window.R_wc.size() <= kLeastIntervals) return {};
  const std::vector<Interval> intervals = long_intervals_of(window);
  const std::int64_t margin_ns = to_ns(kWindow_s + 0.1);
  const Gyroscope samples =
      samples_between(gyroscope,
                      window.timestamps_ns.front() + gyroscope.time_offset_ns - margin_ns,
                      window.timestamps_ns.back() + gyroscope.time_offset_ns + margin_ns);
  if (intervals.size() < kLeastIntervals || samples.timestamps_ns.size() < 2) return {};
  const RateIntegral integral(samples);
  const double recorded_s = 1e-9 * static_cast<double>(gyroscope.time_offset_ns);
  const Pairs now = pairs_at(integral, intervals, recorded_s);
  if (now.images.cols() < std::ptrdiff_t{kLeastIntervals}) return {};
  const double recorded = difference(now, gyroscope.R_gyro_camera);
  if (recorded < kLeast_rad_s) return {};
  const Alternatives other =
      alternatives_to(recorded, integral, intervals, {gyroscope.R_gyro_camera, {}, recorded_s});
  if (other.by_axes < std::min(kFarBetter * other.by_clock, kExplained * scatter_of(now.images)) &&
      other.apart_deg > kLeastAxes_deg)
    return {fmt::format("its axes are about {:.0f} deg off", other.apart_deg)};
  const double half_frame_s = 0.5e-9 * static_cast<double>(median_period_ns(window.timestamps_ns));
  if (other.by_clock < kFarBetter * recorded && std::abs(other.late_s) > half_frame_s)
    return {fmt::format("its clock is about {:+.0f} ms off", 1e3 * other.late_s), other.late_s};
  return {misfit_of_size(now, gyroscope.R_gyro_camera, other.by_clock, sigma_rad)};
}

}  // namespace gpo
