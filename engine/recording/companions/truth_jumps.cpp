// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"
#include "engine/recording/companions/companion_files.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr double kTimesMedian = 5;  // at most 1.1 in recordings with truth, 1.2 for steps
constexpr double kLeastRate_rad_s = 0.5;
constexpr double kLeastSpeed_m_s = 0.25;
constexpr std::ptrdiff_t kNeighbors = 5;  // changes on either side
constexpr std::size_t kLeastNeighbors = 4;

bool stands_out(std::span<const TruthJump> changes,
                std::ptrdiff_t at,
                double (*speed)(const TruthJump&),
                double least) {
  std::vector<double> around;
  const std::ptrdiff_t end = std::min(std::ssize(changes), at + kNeighbors + 1);
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, at - kNeighbors); i < end; ++i)
    if (i != at) around.push_back(speed(changes[i]));
  return around.size() >= kLeastNeighbors &&
         speed(changes[at]) > least + kTimesMedian * median(std::move(around));
}

double seconds(const TruthJump& change) {
  return 1e-9 * static_cast<double>(change.last_ns - change.first_ns);
}
double rate_rad_s(const TruthJump& change) { return radians(change.angle_deg) / seconds(change); }
double speed_m_s(const TruthJump& change) { return change.step_m / seconds(change); }

}  // namespace

std::vector<TruthJump> jumps_of(std::span<const std::int64_t> times_ns,
                                std::span<const std::optional<Pose>> poses) {
  std::vector<TruthJump> changes, jumps;
  std::optional<std::size_t> before;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i]) continue;
    if (before) {
      const Pose change = inverse(*poses[*before]) * *poses[i];
      changes.push_back({.first_ns = times_ns[*before],
                         .last_ns = times_ns[i],
                         .angle_deg = degrees(so3_log(change.R_wc).norm()),
                         .step_m = change.p_wc.norm()});
    }
    before = i;
  }
  bool jumped = false;
  for (std::ptrdiff_t i = 0; i < std::ssize(changes); ++i) {
    const bool jumps_here = stands_out(changes, i, rate_rad_s, kLeastRate_rad_s) ||
                            stands_out(changes, i, speed_m_s, kLeastSpeed_m_s);
    if (jumps_here && !jumped) jumps.push_back(changes[i]);
    jumped = jumps_here;
  }
  return jumps;
}

void keep_between(std::int64_t first_ns, std::int64_t last_ns, std::vector<TruthJump>& jumps) {
  std::erase_if(jumps, [&](const TruthJump& jump) {
    return jump.last_ns <= first_ns || jump.first_ns >= last_ns;
  });
}

std::string text_of(const TruthJump& jump, std::int64_t origin_ns) {
  const bool rotates = rate_rad_s(jump) / kLeastRate_rad_s > speed_m_s(jump) / kLeastSpeed_m_s;
  return fmt::format("ground truth jumps at {:.2f} s: {:.3g} {} within {:.3g} ms",
                     1e-9 * static_cast<double>(jump.first_ns - origin_ns),
                     rotates ? jump.angle_deg : 1e3 * jump.step_m,
                     rotates ? "deg" : "mm",
                     1e3 * seconds(jump));
}

std::vector<std::string> notes_of(std::span<const TruthJump> jumps, std::int64_t origin_ns) {
  constexpr std::size_t kShown = 3;
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < std::min(jumps.size(), kShown); ++i)
    notes.push_back(text_of(jumps[i], origin_ns));
  if (jumps.size() > kShown)
    notes.push_back(fmt::format("ground truth jumps {} more times", jumps.size() - kShown));
  return notes;
}

}  // namespace gpo
