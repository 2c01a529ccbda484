// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inertial/imu_intervals.h"

#include "engine/window/timestamps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr double kGapPeriods = 5;
constexpr double kMarginPeriods = 1.5;

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

struct Sample {
  Eigen::Vector3d rate;          // [rad/s]
  Eigen::Vector3d acceleration;  // [m/s^2]
};

Sample sample(const Gyroscope& gyroscope, std::size_t k) {
  return {gyroscope.rates_rad_s[k], gyroscope.accelerations_m_s2[k]};
}

/// The first sample after a time.
std::size_t next_after(const Gyroscope& gyroscope, std::int64_t t_ns) {
  const auto& t = gyroscope.timestamps_ns;
  return static_cast<std::size_t>(std::ranges::upper_bound(t, t_ns) - t.begin());
}

Sample sample_at(const Gyroscope& gyroscope, std::int64_t t_ns) {
  const auto& t = gyroscope.timestamps_ns;
  const std::size_t after = next_after(gyroscope, t_ns);
  if (after == 0) return sample(gyroscope, 0);
  if (after == t.size()) return sample(gyroscope, t.size() - 1);
  const double u =
      static_cast<double>(t_ns - t[after - 1]) / static_cast<double>(t[after] - t[after - 1]);
  const Sample a = sample(gyroscope, after - 1);
  const Sample b = sample(gyroscope, after);
  return {(1 - u) * a.rate + u * b.rate, (1 - u) * a.acceleration + u * b.acceleration};
}

/// Why the samples do not do between two times; empty: they do.
std::string why_not_covered(const Gyroscope& gyroscope,
                            std::int64_t first_ns,
                            std::int64_t last_ns) {
  if (gyroscope.timestamps_ns.size() < 2 ||
      gyroscope.accelerations_m_s2.size() != gyroscope.timestamps_ns.size())
    return "the recording has no accelerometer";
  // Those of the window, and two more on either side.
  const std::size_t begin = std::max<std::size_t>(next_after(gyroscope, first_ns), 2) - 2;
  const std::size_t end =
      std::min(next_after(gyroscope, last_ns) + 2, gyroscope.timestamps_ns.size());
  const auto t = std::span(gyroscope.timestamps_ns).subspan(begin, end - begin);
  const auto period_ns = static_cast<double>(median_period_ns(t));
  if (t.size() < 2 || static_cast<double>(t.front() - first_ns) > kMarginPeriods * period_ns)
    return "the accelerometer starts after the window's first frame";
  if (static_cast<double>(last_ns - t.back()) > kMarginPeriods * period_ns)
    return "the accelerometer ends before the window's last frame";
  for (std::size_t k = 0; k < t.size(); ++k) {
    const Sample one = sample(gyroscope, begin + k);
    if (!one.rate.allFinite() || !one.acceleration.allFinite())
      return "the accelerometer has values in the window that are no numbers";
    const std::int64_t gap_ns = k > 0 ? t[k] - t[k - 1] : 0;
    if (static_cast<double>(gap_ns) > kGapPeriods * period_ns)
      return fmt::format("the accelerometer has a gap of {:.3f} s in the window", seconds(gap_ns));
  }
  return "";
}

Preintegration between(const Gyroscope& gyroscope,
                       std::int64_t from_ns,
                       std::int64_t to_ns,
                       const Eigen::Vector3d& bias_rad_s,
                       const ImuNoise& noise) {
  const auto& t = gyroscope.timestamps_ns;
  Preintegration sum;
  Sample now = sample_at(gyroscope, from_ns);
  std::size_t k = next_after(gyroscope, from_ns);
  for (std::int64_t now_ns = from_ns; now_ns < to_ns; ++k) {
    const bool inside = k < t.size() && t[k] < to_ns;
    const std::int64_t next_ns = inside ? t[k] : to_ns;
    const Sample next = inside ? sample(gyroscope, k) : sample_at(gyroscope, to_ns);
    advance(sum,
            0.5 * (now.rate + next.rate) - bias_rad_s,
            0.5 * (now.acceleration + next.acceleration),
            seconds(next_ns - now_ns),
            noise);
    now_ns = next_ns;
    now = next;
  }
  return sum;
}

}  // namespace

ImuIntervals imu_intervals(const Gyroscope& gyroscope,
                           std::span<const std::int64_t> frame_times_ns,
                           std::int64_t time_offset_ns,
                           const Eigen::Vector3d& bias_rad_s,
                           const ImuNoise& noise) {
  ImuIntervals intervals;
  intervals.reason = why_not_covered(
      gyroscope, frame_times_ns.front() + time_offset_ns, frame_times_ns.back() + time_offset_ns);
  if (!intervals.reason.empty()) return intervals;
  for (std::size_t i = 1; i < frame_times_ns.size(); ++i)
    intervals.between.push_back(between(gyroscope,
                                        frame_times_ns[i - 1] + time_offset_ns,
                                        frame_times_ns[i] + time_offset_ns,
                                        bias_rad_s,
                                        noise));
  return intervals;
}

std::optional<double> accelerometer_noise_density(const Gyroscope& gyroscope,
                                                  std::int64_t first_ns,
                                                  std::int64_t last_ns) {
  constexpr double kBlock_ns = 1e7;
  constexpr std::size_t kLeastBlocks = 12;
  const std::size_t begin = next_after(gyroscope, first_ns - 1);
  const std::size_t end = next_after(gyroscope, last_ns);
  if (end < begin + kLeastBlocks) return std::nullopt;
  const double period_ns =
      static_cast<double>(gyroscope.timestamps_ns[end - 1] - gyroscope.timestamps_ns[begin]) /
      static_cast<double>(end - begin - 1);
  const auto samples = static_cast<std::size_t>(std::max(1.0, std::round(kBlock_ns / period_ns)));
  std::vector<Eigen::Vector3d> means;
  for (std::size_t k = begin; k + samples <= end; k += samples) {
    means.emplace_back(Eigen::Vector3d::Zero());
    for (std::size_t i = k; i < k + samples; ++i)
      means.back() += gyroscope.accelerations_m_s2[i] / static_cast<double>(samples);
  }
  if (means.size() < kLeastBlocks) return std::nullopt;
  double squares = 0;
  for (std::size_t k = 3; k < means.size(); ++k)
    squares += (means[k] - 3 * means[k - 1] + 3 * means[k - 2] - means[k - 3]).squaredNorm();
  constexpr double kSquaredWeights = 1 + 9 + 9 + 1;
  const double variance = squares / (3 * kSquaredWeights * static_cast<double>(means.size() - 3));
  return std::sqrt(variance * 1e-9 * period_ns * static_cast<double>(samples));
}

}  // namespace gpo
