// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/workbench.h"

#include "ui/workbench/actions.h"

#include <algorithm>
#include <utility>

namespace gpo {

namespace {

constexpr int kLeastWindow = 2;
constexpr int kLongestWindow = 1000;

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

double seconds_of_frame(const Recording& recording, int frame) {
  const auto& times = recording.timestamps_ns;
  return static_cast<double>(times[frame + 1] - times[frame]) * 1e-9;
}

}  // namespace

void push(Commands& commands, const Command& command) { commands.push_back(command); }

void apply(WorkbenchState& state, const Command& command) {
  const auto run = [&](const RunAction& c) { run_action(state, c.name); };
  const auto change = [&](const ChangeSettings& c) {
    state.settings = state.recording ? fit_window(c.settings, state.frame_count()) : c.settings;
  };
  const auto go = [&](const GoToFrame& c) {
    state.frame = std::clamp(c.frame, 0, std::max(0, state.frame_count() - 1));
    state.play_seconds = 0;
  };
  const auto cube = [&](const SetCubeSide& c) { state.cube_side = std::clamp(c.side, 0.0, 2.0); };
  const auto zoom = [&](const ZoomPicture& c) { state.picture_zoom = c.zoom; };
  const auto orbit = [&](const OrbitScene& c) { state.orbit = c.camera; };
  const auto fit = [&](const FitScene&) { state.orbit.reset(); };
  const auto open = [&](const OpenRecording& c) { state.wishes.open = c.path; };
  std::visit(Overloaded{run, change, go, cube, zoom, orbit, fit, open}, command);
}

void advance(WorkbenchState& state, double seconds) {
  if (!state.playing) return;
  state.play_seconds += seconds;
  while (const auto left = seconds_to_next_frame(state)) {
    if (*left > 0) return;
    state.play_seconds -= seconds_of_frame(*state.recording, state.frame);
    ++state.frame;
  }
  state.playing = false;
  state.play_seconds = 0;
}

std::optional<double> seconds_to_next_frame(const WorkbenchState& state) {
  if (!state.playing || state.frame + 1 >= state.frame_count()) return std::nullopt;
  return seconds_of_frame(*state.recording, state.frame) - state.play_seconds;
}

void adopt(WorkbenchState& state, std::shared_ptr<const Recording> recording) {
  state.recording = std::move(recording);
  state.playing = false;
  state.play_seconds = 0;
  state.picture_zoom = {};
  state.orbit.reset();
  const Settings fitting = fit_window(state.settings, state.frame_count());
  state.message = state.recording->notes.empty() ? "" : state.recording->notes.front();
  if (fitting.start != state.settings.start) {
    state.message = "start " + std::to_string(state.settings.start) +
                    " does not fit: the last of " + std::to_string(state.frame_count()) +
                    " frames is " + std::to_string(state.frame_count() - 1);
  }
  state.settings = fitting;
  state.frame = std::max(0, fitting.start + std::min(fitting.frames, state.frame_count()) - 1);
}

Settings fit_window(Settings settings, int frame_count) {
  const int longest = std::clamp(frame_count, kLeastWindow, kLongestWindow);
  settings.frames = std::clamp(settings.frames, kLeastWindow, longest);
  settings.start = std::clamp(settings.start, 0, std::max(0, frame_count - settings.frames));
  return settings;
}

Settings start_window_at(Settings settings, int frame, int frame_count) {
  const int end = settings.start + settings.frames;
  settings.start = std::clamp(frame, 0, std::max(0, frame_count - kLeastWindow));
  if (settings.start <= end - kLeastWindow) {
    settings.frames = end - settings.start;
  } else {
    settings.frames = std::min(settings.frames, frame_count - settings.start);
  }
  return fit_window(settings, frame_count);
}

Settings end_window_at(Settings settings, int frame, int frame_count) {
  const int end = std::clamp(frame + 1, kLeastWindow, std::max(kLeastWindow, frame_count));
  if (end < settings.start + kLeastWindow) settings.start = std::max(0, end - settings.frames);
  settings.start = std::max(settings.start, end - kLongestWindow);
  settings.frames = end - settings.start;
  return fit_window(settings, frame_count);
}

}  // namespace gpo
