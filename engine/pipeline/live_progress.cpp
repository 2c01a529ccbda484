// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/pipeline/live_progress.h"

#include "engine/geometry/pose.h"

#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr double kMostTurnSigmas = 4;  // rotation of the normal that a later answer may cause
constexpr double kLonger = 1.5;  // length of a window that may improve an answer, to the last one

/// Returns why an outcome does not replace the answer; empty if it does.
std::string why_not_better(const LiveProgress& progress, int length, const LiveOutcome& outcome) {
  if (!outcome.is_ready())
    return fmt::format("the window of {} frames is not ready: {}", length, outcome.why_not_ready());
  const Initialization& first = progress.first->initialization;
  const double sigma_deg = first.verdict->normal_sigma_deg.value_or(0);
  const double apart_deg =
      angle_deg(first.plane.normal, outcome.result->initialization.plane.normal);
  if (apart_deg <= kMostTurnSigmas * sigma_deg) return "";
  return fmt::format(
      "the normals of {} and {} frames differ by {:.2f} deg, {:.1f} standard deviations",
      progress.status.ready_frames,
      length,
      apart_deg,
      apart_deg / sigma_deg);
}

}  // namespace

bool LiveProgress::worth_solving(int length) const {
  return !status.ready || length >= kLonger * status.solved_frames;
}

void LiveProgress::take(int length, LiveOutcome outcome) {
  status.solved_frames = length;
  if (status.ready) {
    status.reason = why_not_better(*this, length, outcome);
  } else {
    status.reason = outcome.why_not_ready();
    if (!outcome.is_ready()) return;
    status.ready = true;
    status.ready_frames = length;
    first = outcome.result;
  }
  if (!status.reason.empty()) return;
  status.metric = outcome.result->is_metric();
  status.answer = std::move(outcome.result);
}

}  // namespace gpo
