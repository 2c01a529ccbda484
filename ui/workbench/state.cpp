// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/state.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

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

UndoStep current_step(const Document& document) {
  return {document.settings, document.cube_side, document.cube_ray};
}

void push_undo(Document& document) {
  constexpr std::size_t kMostUndo = 200;
  document.undo.push_back(current_step(document));
  if (document.undo.size() > kMostUndo) document.undo.erase(document.undo.begin());
  document.redo.clear();
}

/// Restores the last step of `from` and appends the current one to `to`.
void step_back(Document& document, std::vector<UndoStep>& from, std::vector<UndoStep>& to) {
  if (from.empty()) return;
  to.push_back(current_step(document));
  document.settings = from.back().settings;
  document.cube_side = from.back().cube_side;
  document.cube_ray = from.back().cube_ray;
  from.pop_back();
  document.dragging_settings = false;
}

/// The tracks seen in the current frame for which `takes(frame in window, column)`.
std::vector<std::int64_t> tracks_if(const WorkbenchState& state, auto&& takes) {
  std::vector<std::int64_t> ids;
  if (!state.results.inspection) return ids;
  const Tracks& tracks = *state.results.inspection->tracks;
  const int frame = state.view.frame - tracks.start;
  if (frame < 0 || frame >= tracks.frame_count()) return ids;
  for (int column = 0; column < tracks.track_count(); ++column)
    if (tracks.seen(frame, column) && takes(frame, column)) ids.push_back(tracks.ids[column]);
  std::ranges::sort(ids);
  return ids;
}

}  // namespace

void say(WorkbenchState& state, const std::string& text, Severity severity) {
  constexpr std::size_t kMostLines = 1000;
  state.messages.text = text;
  state.messages.severity = severity;
  state.messages.seconds = 0;
  if (text.empty()) return;
  state.messages.lines.push_back({severity, text});
  if (state.messages.lines.size() > kMostLines)
    state.messages.lines.erase(state.messages.lines.begin());
}

std::optional<double> seconds_of_message(const WorkbenchState& state) {
  constexpr double kShown_s = 12;
  if (state.messages.text.empty()) return std::nullopt;
  if (state.messages.severity == Severity::error) return std::numeric_limits<double>::infinity();
  const double left = kShown_s - state.messages.seconds;
  return left > 0 ? std::optional(left) : std::nullopt;
}

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

std::optional<double> seconds_to_next_frame(const WorkbenchState& state) {
  if (!state.view.playing || state.frame_count() < 2) return std::nullopt;
  const bool last = state.view.frame + 1 >= state.frame_count();
  if (last && !at_end_of_loop(state)) return std::nullopt;
  // The last frame has no duration of its own.
  const double duration =
      seconds_of_frame(*state.document.recording, last ? state.view.frame - 1 : state.view.frame);
  return (duration - state.view.play_seconds) / state.view.speed;
}

void change_settings(WorkbenchState& state, Settings settings, bool dragging) {
  Document& document = state.document;
  if (document.recording) settings = fit_window(settings, state.frame_count());
  // Track ids count from the reference frame, so excluded ones are meaningless for another start.
  if (settings.start != document.settings.start) settings.exclude.clear();
  if (settings == document.settings) return;
  if (!dragging || !document.dragging_settings) push_undo(document);
  document.dragging_settings = dragging;
  document.redo.clear();
  document.settings = std::move(settings);
}

void move_cube(WorkbenchState& state, const std::optional<Eigen::Vector3d>& ray) {
  if (ray == state.document.cube_ray) return;
  push_undo(state.document);
  state.document.dragging_settings = false;
  state.document.cube_ray = ray;
}

void undo(WorkbenchState& state) {
  step_back(state.document, state.document.undo, state.document.redo);
}

void redo(WorkbenchState& state) {
  step_back(state.document, state.document.redo, state.document.undo);
}

std::vector<std::int64_t> tracks_of_window(const WorkbenchState& state) {
  if (!state.results.inspection) return {};
  std::vector<std::int64_t> ids = state.results.inspection->tracks->ids;
  std::ranges::sort(ids);
  return ids;
}

std::vector<std::int64_t> tracks_in_view(const WorkbenchState& state) {
  return tracks_if(state, [](int, int) { return true; });
}

std::vector<std::int64_t> outliers_in_view(const WorkbenchState& state) {
  return tracks_if(state, [&](int frame, int column) {
    return !state.results.inspection->window->inlier[frame][column];
  });
}

std::vector<std::int64_t> tracks_within(const WorkbenchState& state,
                                        const Eigen::Vector2d& a,
                                        const Eigen::Vector2d& b) {
  const Eigen::AlignedBox2d box(a.cwiseMin(b), a.cwiseMax(b));
  return tracks_if(state, [&](int frame, int column) {
    return box.contains(state.results.inspection->tracks->raw_px[frame].col(column).eval());
  });
}

std::optional<int> column_of(const Tracks& tracks, std::int64_t id) {
  const auto found = std::ranges::find(tracks.ids, id);
  if (found == tracks.ids.end()) return std::nullopt;
  return static_cast<int>(found - tracks.ids.begin());
}

}  // namespace gpo
