// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/window/gyroscope_rest.h"

#include "engine/window/timestamps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace gpo {
namespace {

using Eigen::Array3d;
using Eigen::Vector3d;

constexpr std::int64_t kBlock_ns = 100'000'000;
constexpr std::size_t kLeastBlocks = 4;
constexpr std::size_t kLeastInBlock = 3;
constexpr double kQuiet_rad_s = 0.02;   // standard deviation within a block, each axis
constexpr double kSteady_rad_s = 0.01;  // difference of a block's mean from the first block's

/// Size of a sensor's noise. Below `negligible` its color does not matter, as quantized values are
/// not white; above `most` it is motion or vibration.
struct NoiseLimits {
  double negligible, most;
};
constexpr NoiseLimits kRates_rad_s{0.002, 0.01};
constexpr NoiseLimits kAccelerations_m_s2{0.02, 0.15};
constexpr double kMostColor = 1.5;  // standard deviation relative to that of white noise
constexpr double kLag_s = 0.02;     // noise of a low-pass filter is forgotten, motion is not
constexpr double kGravity_m_s2 = 9.81, kMostGravityError_m_s2 = 1;

struct Moments {
  Vector3d mean = Vector3d::Zero();
  Array3d sigma = Array3d::Zero();
};

Moments moments_of(std::span<const Vector3d> values) {
  Moments moments;
  const auto count = static_cast<double>(values.size());
  for (const Vector3d& value : values) moments.mean += value / count;
  for (const Vector3d& value : values)
    moments.sigma += (value - moments.mean).array().square() / count;
  moments.sigma = moments.sigma.sqrt();
  return moments;
}

/// Standard deviation of white noise with the same differences over a time of `lag` samples.
Array3d white_sigma(std::span<const Vector3d> values, std::size_t lag) {
  Array3d squares = Array3d::Zero();
  for (std::size_t k = lag; k < values.size(); ++k)
    squares += (values[k] - values[k - lag]).array().square();
  return (squares / (2 * static_cast<double>(values.size() - lag))).sqrt();
}

/// Returns whether all values are the same.
bool is_constant(std::span<const Vector3d> values) {
  return std::ranges::all_of(values, [&](const Vector3d& one) { return one == values.front(); });
}

/// Returns whether the values vary by a sensor's noise only. NaN do not.
bool is_at_rest(const Moments& moments,
                std::span<const Vector3d> values,
                std::size_t lag,
                const NoiseLimits& limits) {
  const Array3d allowed =
      (kMostColor * white_sigma(values, lag)).max(limits.negligible).min(limits.most);
  return !is_constant(values) && (moments.sigma <= allowed).all();
}

QuietSpan span_of(const Gyroscope& gyroscope, std::size_t begin, std::size_t end) {
  const auto [mean, sigma] =
      moments_of(std::span(gyroscope.rates_rad_s).subspan(begin, end - begin));
  return {begin, end, mean, sigma.maxCoeff()};
}

/// Successive blocks of 0.1 s; a gap makes a block of few samples, which is not quiet.
std::vector<QuietSpan> blocks_of(const Gyroscope& gyroscope) {
  const auto& times_ns = gyroscope.timestamps_ns;
  std::vector<QuietSpan> blocks;
  std::size_t begin = 0;
  for (std::size_t k = 1; k < times_ns.size(); ++k) {
    if (times_ns[k] - times_ns[begin] < kBlock_ns) continue;
    blocks.push_back(span_of(gyroscope, begin, k));
    if (k - begin < kLeastInBlock || times_ns[k] - times_ns[k - 1] > kBlock_ns)
      blocks.back().sigma_rad_s = std::numeric_limits<double>::infinity();
    begin = k;
  }
  return blocks;
}

}  // namespace

std::vector<QuietSpan> quiet_spans(const Gyroscope& gyroscope) {
  const std::vector<QuietSpan> blocks = blocks_of(gyroscope);
  std::vector<QuietSpan> spans;
  for (std::size_t begin = 0, end = 0; begin < blocks.size(); begin = std::max(begin + 1, end)) {
    end = begin;
    while (end < blocks.size() && blocks[end].sigma_rad_s < kQuiet_rad_s &&
           (blocks[end].mean_rad_s - blocks[begin].mean_rad_s).norm() < kSteady_rad_s)
      ++end;
    if (end - begin >= kLeastBlocks)
      spans.push_back(span_of(gyroscope, blocks[begin].begin, blocks[end - 1].end));
  }
  const auto duration_ns = [&](const QuietSpan& one) {
    return gyroscope.timestamps_ns[one.end - 1] - gyroscope.timestamps_ns[one.begin];
  };
  std::ranges::stable_sort(spans, std::ranges::greater(), duration_ns);
  return spans;
}

std::optional<SensorsAtRest> sensors_at_rest(const Gyroscope& gyroscope,
                                             std::size_t begin,
                                             std::size_t end) {
  constexpr std::size_t kLeastSamples = 10;
  const std::size_t count = end - begin;
  if (end < begin + kLeastSamples) return std::nullopt;
  const auto times_ns = std::span(gyroscope.timestamps_ns).subspan(begin, count);
  const double period_s = 1e-9 * static_cast<double>(median_period_ns(times_ns));
  const auto lag = static_cast<std::size_t>(
      std::clamp(std::round(kLag_s / period_s), 1.0, static_cast<double>(count / 2)));
  const auto rates = std::span(gyroscope.rates_rad_s).subspan(begin, count);
  const Moments of_rates = moments_of(rates);
  if (!is_at_rest(of_rates, rates, lag, kRates_rad_s)) return std::nullopt;
  SensorsAtRest rest{of_rates.mean, std::nullopt};
  const auto& all = gyroscope.accelerations_m_s2;
  if (is_constant(all)) return rest;
  const auto accelerations = std::span(all).subspan(begin, count);
  const Moments moments = moments_of(accelerations);
  const double error_m_s2 = std::abs(moments.mean.norm() - kGravity_m_s2);
  if (!is_at_rest(moments, accelerations, lag, kAccelerations_m_s2) ||
      !(error_m_s2 < kMostGravityError_m_s2))
    return std::nullopt;
  rest.mean_m_s2 = moments.mean;
  rest.most_m_s2 = std::max(kAccelerations_m_s2.negligible, moments.sigma.maxCoeff());
  return rest;
}

double sigmas_from_prior(const Gyroscope& gyroscope, const Vector3d& bias_rad_s) {
  return (bias_rad_s - gyroscope.bias_rad_s).norm() / gyroscope.bias_sigma_rad_s;
}

}  // namespace gpo
