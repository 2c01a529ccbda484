// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/playing.h"

#include <algorithm>
#include <limits>

namespace gpo {
namespace {

double seconds_of_frame(const Recording& recording, int frame) {
  const auto& times = recording.timestamps_ns;
  return static_cast<double>(times[frame + 1] - times[frame]) * 1e-9;
}

bool at_end_of_loop(const WorkbenchState& state) {
  return state.loop && state.frame >= state.settings.start + state.settings.frames - 1;
}

}  // namespace

void go_to_frame(WorkbenchState& state, int frame) {
  state.frame = std::clamp(frame, 0, std::max(0, state.frame_count() - 1));
  state.play_seconds = 0;
}

void advance(WorkbenchState& state, double seconds) {
  state.message_seconds += seconds;
  if (!seconds_of_message(state)) state.message.clear();
  if (!state.playing) return;
  state.play_seconds += seconds * state.speed;
  while (const auto left = seconds_to_next_frame(state)) {
    if (*left > 0) return;
    state.play_seconds -=
        seconds_of_frame(*state.recording, std::min(state.frame, state.frame_count() - 2));
    state.frame = at_end_of_loop(state) ? state.settings.start : state.frame + 1;
  }
  state.playing = false;
  state.play_seconds = 0;
}

std::optional<double> seconds_of_message(const WorkbenchState& state) {
  constexpr double kShown_s = 12;
  if (state.message.empty()) return std::nullopt;
  if (state.message_severity == Severity::error) return std::numeric_limits<double>::infinity();
  const double left = kShown_s - state.message_seconds;
  return left > 0 ? std::optional(left) : std::nullopt;
}

std::optional<double> seconds_to_next_frame(const WorkbenchState& state) {
  if (!state.playing || state.frame_count() < 2) return std::nullopt;
  const bool last = state.frame + 1 >= state.frame_count();
  if (last && !at_end_of_loop(state)) return std::nullopt;
  // The last frame has no duration of its own.
  const double duration = seconds_of_frame(*state.recording, last ? state.frame - 1 : state.frame);
  return (duration - state.play_seconds) / state.speed;
}

}  // namespace gpo
