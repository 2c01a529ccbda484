// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/window/gyroscope.h"

#include "engine/window/timestamps.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr double kGapPeriods = 5;
constexpr std::size_t kAround = 16;     // samples on either side of the span, to find the period
constexpr double kMarginPeriods = 1.5;  // allowed beyond the first and the last sample

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

InertialSample sample(const Gyroscope& gyroscope, std::size_t k) {
  InertialSample sample{gyroscope.rates_rad_s[k]};
  if (!gyroscope.accelerations_m_s2.empty())
    sample.acceleration_m_s2 = gyroscope.accelerations_m_s2[k];
  return sample;
}

InertialSample between(const InertialSample& a, const InertialSample& b, double u) {
  return {(1 - u) * a.rate_rad_s + u * b.rate_rad_s,
          (1 - u) * a.acceleration_m_s2 + u * b.acceleration_m_s2};
}

/// Returns "file:line" of a sample.
std::string place(const Gyroscope& gyroscope, std::size_t k) {
  const std::string file = gyroscope.file.string();
  return k < gyroscope.lines.size() ? fmt::format("{}:{}", file, gyroscope.lines[k]) : file;
}

std::string why_gap(const Gyroscope& gyroscope, std::size_t k, double period_ns) {
  const auto& t = gyroscope.timestamps_ns;
  const std::int64_t dt_ns = t[k] - t[k - 1];
  if (dt_ns <= 0)
    return fmt::format(
        "{}: time stamp {} does not come after {}", place(gyroscope, k), t[k], t[k - 1]);
  if (static_cast<double>(dt_ns) <= kGapPeriods * period_ns) return "";
  return fmt::format(
      "{}: gap of {:.3f} s in the gyroscope's samples before {} ns, inside the window; expected "
      "about {:.4f} s",
      place(gyroscope, k),
      seconds(dt_ns),
      t[k],
      period_ns * 1e-9);
}

}  // namespace

double held_bias_sigma_rad_s(const Gyroscope& gyroscope) {
  const bool stated = gyroscope.bias_known || !gyroscope.bias_rad_s.isZero(0);
  const bool has_sigma = gyroscope.bias_sigma_rad_s != kUnknownBiasSigma_rad_s;
  return stated && !has_sigma ? kStatedBiasSigma_rad_s : gyroscope.bias_sigma_rad_s;
}

std::size_t first_after(const Gyroscope& gyroscope, std::int64_t t_ns) {
  const auto& t = gyroscope.timestamps_ns;
  return static_cast<std::size_t>(std::ranges::upper_bound(t, t_ns) - t.begin());
}

std::string why_not_covered(const Gyroscope& gyroscope,
                            std::int64_t first_ns,
                            std::int64_t last_ns) {
  const auto& t = gyroscope.timestamps_ns;
  if (t.size() < 2)
    return fmt::format("{}: {} samples, expected at least 2", gyroscope.file.string(), t.size());
  const std::size_t begin = std::max(first_after(gyroscope, first_ns), kAround) - kAround;
  const std::size_t end = std::min(first_after(gyroscope, last_ns) + kAround, t.size());
  const auto period_ns =
      static_cast<double>(median_period_ns(std::span(t).subspan(begin, end - begin)));
  if (static_cast<double>(t.front() - first_ns) > kMarginPeriods * period_ns)
    return fmt::format("{}: the gyroscope starts at {} ns, {:.3f} s after the window's first frame",
                       place(gyroscope, 0),
                       t.front(),
                       seconds(t.front() - first_ns));
  if (static_cast<double>(last_ns - t.back()) > kMarginPeriods * period_ns)
    return fmt::format("{}: the gyroscope ends at {} ns, {:.3f} s before the window's last frame",
                       place(gyroscope, t.size() - 1),
                       t.back(),
                       seconds(last_ns - t.back()));
  for (std::size_t k = begin + 1; k < end; ++k) {
    if (t[k] <= first_ns || t[k - 1] >= last_ns) continue;
    if (std::string reason = why_gap(gyroscope, k, period_ns); !reason.empty()) return reason;
  }
  return "";
}

InertialSample sample_at(const Gyroscope& gyroscope, std::int64_t t_ns) {
  const auto& t = gyroscope.timestamps_ns;
  const std::size_t k = first_after(gyroscope, t_ns);
  if (k == 0) return sample(gyroscope, 0);
  if (k == t.size()) return sample(gyroscope, t.size() - 1);
  const double u = static_cast<double>(t_ns - t[k - 1]) / static_cast<double>(t[k] - t[k - 1]);
  return between(sample(gyroscope, k - 1), sample(gyroscope, k), u);
}

void integrate(const Gyroscope& gyroscope,
               std::int64_t from_ns,
               std::int64_t to_ns,
               const std::function<void(const InertialSample& mean, double dt_s)>& advance) {
  const auto& t = gyroscope.timestamps_ns;
  InertialSample now = sample_at(gyroscope, from_ns);
  std::size_t k = first_after(gyroscope, from_ns);
  for (std::int64_t now_ns = from_ns; now_ns < to_ns; ++k) {
    const bool inside = k < t.size() && t[k] < to_ns;
    const std::int64_t next_ns = inside ? t[k] : to_ns;
    const InertialSample next = inside ? sample(gyroscope, k) : sample_at(gyroscope, to_ns);
    advance({0.5 * (now.rate_rad_s + next.rate_rad_s),
             0.5 * (now.acceleration_m_s2 + next.acceleration_m_s2)},
            seconds(next_ns - now_ns));
    now_ns = next_ns;
    now = next;
  }
}

}  // namespace gpo
