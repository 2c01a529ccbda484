// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/workbench.h"

#include "engine/experiment/configuration.h"
#include "ui/workbench/actions.h"
#include "ui/workbench/compared.h"
#include "ui/workbench/session_file.h"

#include <algorithm>
#include <iterator>
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

void say(WorkbenchState& state, const std::string& text, Severity severity) {
  constexpr std::size_t kMostLines = 1000;
  state.message = text;
  if (text.empty()) return;
  state.log.push_back({severity, text});
  if (state.log.size() > kMostLines) state.log.erase(state.log.begin());
}

void change_settings(WorkbenchState& state, Settings settings, bool dragging) {
  constexpr std::size_t kMostUndo = 200;
  if (state.recording) settings = fit_window(settings, state.frame_count());
  // Their ids count within the tracks of one reference frame.
  if (settings.start != state.settings.start) settings.exclude.clear();
  if (settings == state.settings) return;
  if (!dragging || !state.dragging_settings) state.undo.push_back(state.settings);
  if (state.undo.size() > kMostUndo) state.undo.erase(state.undo.begin());
  state.dragging_settings = dragging;
  state.redo.clear();
  state.settings = std::move(settings);
}

std::vector<Settings> wanted_inspections(const WorkbenchState& state) {
  std::vector<Settings> wanted;
  const bool curves = state.panes.drawer == Drawer::curves;
  const bool now = curves || state.panes.compare || state.panes.drawer == Drawer::table ||
                   state.panes.drawer == Drawer::timing || state.panes.side == SidePane::normals ||
                   state.panes.side == SidePane::solver;
  if (!state.recording) return wanted;
  const std::optional<std::string> other = flipped(state);
  if (!now && other) wanted.push_back(apply(parse_configuration(*other), compared_base(state)));
  if (!now) return wanted;
  const auto want_each = [&](int frames) {
    Settings window = state.settings;
    window.frames = frames;
    std::ranges::copy(compared_settings(state, window), std::back_inserter(wanted));
  };
  want_each(state.settings.frames);
  // The longest first: its tracks serve the others.
  for (const int frames : curve_lengths(state.settings.frames))
    if (curves && frames < state.settings.frames) want_each(frames);
  return wanted;
}

void apply(WorkbenchState& state, const Command& command) {
  const auto run = [&](const RunAction& c) { run_action(state, c.line); };
  const auto change = [&](const ChangeSettings& c) {
    change_settings(state, c.settings, c.dragging);
  };
  const auto go = [&](const GoToFrame& c) {
    state.frame = std::clamp(c.frame, 0, std::max(0, state.frame_count() - 1));
    state.play_seconds = 0;
  };
  const auto cube = [&](const SetCubeSide& c) { state.cube_side = std::clamp(c.side, 0.0, 2.0); };
  const auto move = [&](const MoveCube& c) { state.cube_ray = c.ray; };
  const auto zoom = [&](const ZoomPicture& c) { state.picture_zoom = c.zoom; };
  const auto zoom_all = [&](const ZoomCompare& c) { state.compare_zoom = c.zoom; };
  const auto normals = [&](const ZoomNormals& c) { state.normals_zoom = c.zoom; };
  const auto orbit = [&](const OrbitScene& c) { state.orbit = c.camera; };
  const auto fit = [&](const FitScene&) { state.orbit.reset(); };
  const auto open = [&](const OpenPath& c) { state.wishes.open = c.path; };
  const auto hover = [&](const HoverOver& c) { state.hover = c.hover; };
  const auto select = [&](const SelectTracks& c) { state.selection = c.selection; };
  std::visit(
      Overloaded{
          run, change, go, cube, move, zoom, zoom_all, normals, orbit, fit, open, hover, select},
      command);
}

namespace {

bool at_end_of_loop(const WorkbenchState& state) {
  return state.loop && state.frame >= state.settings.start + state.settings.frames - 1;
}

}  // namespace

void advance(WorkbenchState& state, double seconds) {
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

std::optional<double> seconds_to_next_frame(const WorkbenchState& state) {
  if (!state.playing || state.frame_count() < 2) return std::nullopt;
  const bool last = state.frame + 1 >= state.frame_count();
  if (last && !at_end_of_loop(state)) return std::nullopt;
  // The last frame has no duration of its own.
  const double duration = seconds_of_frame(*state.recording, last ? state.frame - 1 : state.frame);
  return (duration - state.play_seconds) / state.speed;
}

void adopt(WorkbenchState& state, std::shared_ptr<const Recording> recording) {
  state.recording = std::move(recording);
  state.inspection.reset();
  state.surveyed = std::make_shared<const SurveyResults>();
  state.study.reset();
  state.selection = {};
  state.hover = {};
  state.cube_ray.reset();
  state.bookmarks.clear();
  state.settings.exclude.clear();
  state.undo.clear();
  state.redo.clear();
  state.playing = false;
  state.play_seconds = 0;
  state.picture_zoom = {};
  state.compare_zoom.reset();
  state.normals_zoom = {};
  state.orbit.reset();
  const Settings fitting = fit_window(state.settings, state.frame_count());
  state.message.clear();
  for (const std::string& note : state.recording->notes) say(state, note);
  if (!state.recording->notes.empty()) state.message = state.recording->notes.front();
  if (fitting.start != state.settings.start) {
    say(state,
        "start " + std::to_string(state.settings.start) + " does not fit: the last of " +
            std::to_string(state.frame_count()) + " frames is " +
            std::to_string(state.frame_count() - 1),
        Severity::warning);
  }
  state.settings = fitting;
  state.time_span = first_time_span(fitting, state.frame_count());
  state.frame = std::max(0, fitting.start + std::min(fitting.frames, state.frame_count()) - 1);
  if (const auto session = std::exchange(state.waiting_session, {}))
    continue_session(state, *session);
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
