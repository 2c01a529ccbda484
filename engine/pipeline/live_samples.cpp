// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/pipeline/live_samples.h"

#include "engine/base/error.h"
#include "engine/pipeline/pipeline.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kAround_ns = kSecond_ns;           // a window uses samples this far beyond
constexpr std::int64_t kLongestWait_ns = kSecond_ns / 2;  // a frame waits for samples
constexpr std::int64_t kLongest_ns = 600 * kSecond_ns;    // older samples are dropped

}  // namespace

LiveSamples::LiveSamples(const std::optional<Gyroscope>& given) : gyroscope_(given) {
  if (!gyroscope_) return;
  check_gyroscope(*gyroscope_);
  if (gyroscope_->file.empty()) gyroscope_->file = "gyroscope";
  const auto times_ns = std::exchange(gyroscope_->timestamps_ns, {});
  const auto rates = std::exchange(gyroscope_->rates_rad_s, {});
  const auto accelerations = std::exchange(gyroscope_->accelerations_m_s2, {});
  gyroscope_->lines.clear();
  has_accelerations_ = !accelerations.empty();
  for (std::size_t k = 0; k < times_ns.size(); ++k)
    samples_.push_back(
        {times_ns[k],
         {rates[k], has_accelerations_ ? accelerations[k] : Eigen::Vector3d::Zero().eval()}});
  if (!times_ns.empty()) last_ns_ = times_ns.back();
}

void LiveSamples::add(std::int64_t timestamp_ns,
                      const Eigen::Vector3d& rate_rad_s,
                      const Eigen::Vector3d* acceleration_m_s2) {
  if (last_ns_ && timestamp_ns <= *last_ns_)
    throw InputError(
        fmt::format("gyroscope: time stamp {} does not come after {}", timestamp_ns, *last_ns_));
  check_sample(timestamp_ns, rate_rad_s, acceleration_m_s2);
  const bool accelerated = acceleration_m_s2 != nullptr;
  if (last_ns_ && accelerated != has_accelerations_)
    throw InputError("accelerometer: expected an acceleration with each sample, or with none");
  if (!gyroscope_) gyroscope_.emplace().file = "gyroscope";
  if (!closed_) {
    samples_.push_back({timestamp_ns, {rate_rad_s}});
    if (accelerated) samples_.back().measured.acceleration_m_s2 = *acceleration_m_s2;
    while (samples_.front().timestamp_ns < timestamp_ns - kLongest_ns) samples_.pop_front();
  }
  has_accelerations_ = accelerated;
  last_ns_ = timestamp_ns;
}

void LiveSamples::drop_before(std::int64_t frame_ns) {
  const std::int64_t first_ns = frame_ns + time_offset_ns() - kAround_ns;
  while (!samples_.empty() && samples_.front().timestamp_ns < first_ns) samples_.pop_front();
}

Coverage LiveSamples::coverage(std::int64_t first_ns,
                               std::int64_t last_ns,
                               std::int64_t newest_ns,
                               bool is_new) const {
  using enum Coverage::Kind;
  if (!last_ns_) return {none};
  const std::int64_t offset_ns = time_offset_ns();
  const auto window = of_window(first_ns, last_ns, last_ns_);
  std::string gap = why_not_covered(*window, first_ns + offset_ns, last_ns + offset_ns);
  const bool is_passed = *last_ns_ >= last_ns + offset_ns;
  if (gap.empty() && (is_passed || is_new)) return {complete};
  if (!is_passed && newest_ns + offset_ns - *last_ns_ <= kLongestWait_ns) return {waiting};
  if (*last_ns_ <= first_ns + offset_ns) return {none};
  return gap.empty() ? Coverage{complete} : Coverage{broken, std::move(gap)};
}

std::optional<Gyroscope> LiveSamples::of_window(std::int64_t first_ns,
                                                std::int64_t last_ns,
                                                std::optional<std::int64_t> until_ns) const {
  if (!gyroscope_ || !until_ns) return gyroscope_;
  const std::int64_t from_ns = first_ns + time_offset_ns() - kAround_ns;
  const std::int64_t to_ns = std::min(*until_ns, last_ns + time_offset_ns() + kAround_ns);
  Gyroscope window = *gyroscope_;
  for (auto sample = std::ranges::lower_bound(samples_, from_ns, {}, &Sample::timestamp_ns);
       sample != samples_.end() && sample->timestamp_ns <= to_ns;
       ++sample) {
    window.timestamps_ns.push_back(sample->timestamp_ns);
    window.rates_rad_s.push_back(sample->measured.rate_rad_s);
    if (has_accelerations_) window.accelerations_m_s2.push_back(sample->measured.acceleration_m_s2);
  }
  return window;
}

}  // namespace gpo
