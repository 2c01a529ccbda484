// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inertial/imu_intervals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace gpo {
namespace {

/// Why the samples do not do between two times; empty: they do.
std::string why_useless(const Gyroscope& gyroscope, std::int64_t first_ns, std::int64_t last_ns) {
  if (gyroscope.timestamps_ns.size() < 2 ||
      gyroscope.accelerations_m_s2.size() != gyroscope.timestamps_ns.size())
    return "the recording has no accelerometer";
  if (std::string reason = why_not_covered(gyroscope, first_ns, last_ns); !reason.empty())
    return reason;
  // Those of the window, and two more on either side.
  const std::size_t begin = std::max<std::size_t>(first_after(gyroscope, first_ns), 2) - 2;
  const std::size_t end =
      std::min(first_after(gyroscope, last_ns) + 2, gyroscope.timestamps_ns.size());
  for (std::size_t k = begin; k < end; ++k)
    if (!gyroscope.rates_rad_s[k].allFinite() || !gyroscope.accelerations_m_s2[k].allFinite())
      return "the accelerometer has values in the window that are no numbers";
  return "";
}

}  // namespace

ImuIntervals imu_intervals(const Gyroscope& gyroscope,
                           std::span<const std::int64_t> frame_times_ns,
                           std::int64_t time_offset_ns,
                           const Eigen::Vector3d& bias_rad_s,
                           const ImuNoise& noise) {
  ImuIntervals intervals;
  const auto at = [&](std::size_t i) { return frame_times_ns[i] + time_offset_ns; };
  intervals.reason = why_useless(gyroscope, at(0), at(frame_times_ns.size() - 1));
  if (!intervals.reason.empty()) return intervals;
  for (std::size_t i = 1; i < frame_times_ns.size(); ++i) {
    Preintegration& sum = intervals.between.emplace_back();
    integrate(gyroscope, at(i - 1), at(i), [&](const InertialSample& mean, double dt_s) {
      advance(sum, mean.rate_rad_s - bias_rad_s, mean.acceleration_m_s2, dt_s, noise);
    });
  }
  return intervals;
}

std::optional<double> accelerometer_noise_density(const Gyroscope& gyroscope,
                                                  std::int64_t first_ns,
                                                  std::int64_t last_ns) {
  constexpr double kBlock_ns = 1e7;
  constexpr std::size_t kLeastBlocks = 12;
  const std::size_t begin = first_after(gyroscope, first_ns - 1);
  const std::size_t end = first_after(gyroscope, last_ns);
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
