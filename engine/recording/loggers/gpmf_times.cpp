// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/loggers/gpmf.h"

#include <cmath>

namespace gpo {
namespace {

/// time = at_first + step * sample, by least squares.
struct Line {
  double at_first = 0, step = 0;
  double operator()(double sample) const { return at_first + step * sample; }
};

std::optional<Line> fitted(const std::vector<Eigen::Vector2d>& sample_and_time) {
  const auto n = static_cast<double>(sample_and_time.size());
  if (sample_and_time.size() < 2) return std::nullopt;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& one : sample_and_time) mean += one / n;
  double squares = 0, products = 0;
  for (const auto& one : sample_and_time) {
    squares += (one.x() - mean.x()) * (one.x() - mean.x());
    products += (one.x() - mean.x()) * (one.y() - mean.y());
  }
  if (!(squares > 0) || !(products > 0)) return std::nullopt;
  const double step = products / squares;
  return Line{mean.y() - step * mean.x(), step};
}

/// Of the stamps that payloads have [us]; nothing where fewer than two have one.
template <class StampOf>
std::optional<Line> camera_line(const std::vector<GpmfPayload>& payloads, const StampOf& stamp_of) {
  std::vector<Eigen::Vector2d> points;
  for (const GpmfPayload& payload : payloads) {
    const GpmfStamp* stamp = stamp_of(payload);
    if (stamp == nullptr || !stamp->camera_us) continue;
    points.emplace_back(static_cast<double>(stamp->first_sample), *stamp->camera_us);
  }
  return fitted(points);
}

/// In seconds from the first frame.
std::optional<Line> sample_line(const std::vector<GpmfPayload>& payloads,
                                const std::vector<double>& payload_times_s) {
  const auto with_rates = [](const GpmfPayload& p) {
    return p.rates_rad_s.empty() ? nullptr : &p.gyroscope;
  };
  const auto exposures = [](const GpmfPayload& p) { return p.exposures ? &*p.exposures : nullptr; };
  const auto rates_us = camera_line(payloads, with_rates);
  const auto frames_us = camera_line(payloads, exposures);
  if (rates_us && frames_us)
    return Line{1e-6 * (rates_us->at_first - frames_us->at_first), 1e-6 * rates_us->step};
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < payloads.size(); ++i) {
    if (payloads[i].rates_rad_s.empty()) continue;
    const auto first = static_cast<double>(payloads[i].gyroscope.first_sample);
    points.emplace_back(first, payload_times_s[i]);
    if (payloads.size() > 1) continue;
    points.emplace_back(first + static_cast<double>(payloads[i].rates_rad_s.size()),
                        payload_times_s[i + 1]);
  }
  return fitted(points);
}

}  // namespace

std::vector<std::int64_t> gpmf_times_ns(const std::vector<GpmfPayload>& payloads,
                                        const std::vector<double>& payload_times_s) {
  constexpr double kMost_s = 4e9;
  const auto line = sample_line(payloads, payload_times_s);
  std::vector<std::int64_t> times;
  if (!line) return times;
  for (const GpmfPayload& payload : payloads) {
    for (std::size_t k = 0; k < payload.rates_rad_s.size(); ++k) {
      const double time_s =
          (*line)(static_cast<double>(payload.gyroscope.first_sample) + static_cast<double>(k));
      if (!(std::abs(time_s) < kMost_s)) return {};
      times.push_back(std::llround(1e9 * time_s));
    }
  }
  return times;
}

}  // namespace gpo
