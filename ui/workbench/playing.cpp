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
  return state.view.loop &&
         state.view.frame >= state.document.settings.start + state.document.settings.frames - 1;
}

}  // namespace

void go_to_frame(WorkbenchState& state, int frame) {
  state.view.frame = std::clamp(frame, 0, std::max(0, state.frame_count() - 1));
  state.view.play_seconds = 0;
}

void advance(WorkbenchState& state, double seconds) {
  state.messages.seconds += seconds;
  if (!seconds_of_message(state)) state.messages.text.clear();
  if (!state.view.playing) return;
  state.view.play_seconds += seconds * state.view.speed;
  while (const auto left = seconds_to_next_frame(state)) {
    if (*left > 0) return;
    state.view.play_seconds -= seconds_of_frame(
        *state.document.recording, std::min(state.view.frame, state.frame_count() - 2));
    state.view.frame = at_end_of_loop(state) ? state.document.settings.start : state.view.frame + 1;
  }
  state.view.playing = false;
  state.view.play_seconds = 0;
}

std::optional<double> seconds_of_message(const WorkbenchState& state) {
  constexpr double kShown_s = 12;
  if (state.messages.text.empty()) return std::nullopt;
  if (state.messages.severity == Severity::error) return std::numeric_limits<double>::infinity();
  const double left = kShown_s - state.messages.seconds;
  return left > 0 ? std::optional(left) : std::nullopt;
}

std::optional<double> seconds_to_next_frame(const WorkbenchState& state) {
  if (!state.view.playing || state.frame_count() < 2) return std::nullopt;
  const bool last = state.view.frame + 1 >= state.frame_count();
  if (last && !at_end_of_loop(state)) return std::nullopt;
  // The last frame has no duration of its own.
  const double duration =
      seconds_of_frame(*state.document.recording, last ? state.view.frame - 1 : state.view.frame);
  return (duration - state.view.play_seconds) / state.view.speed;
}

}  // namespace gpo
