// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/state.h"

#include "engine/base/error.h"

#include <algorithm>
#include <limits>
#include <set>
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

constexpr int kFewest = 10;  // frames of the time line
constexpr int kLeastWindow = 2, kLongestWindow = 1000;

TimeSpan within(double first, int count, int frames) {
  if (count >= frames) return {};
  const auto least = static_cast<int>(std::lround(first));
  return {std::clamp(least, 0, frames - count), count};
}

void push_undo(Document& document) {
  constexpr std::size_t kMostUndo = 200;
  document.undo.push_back(document);
  if (document.undo.size() > kMostUndo) document.undo.erase(document.undo.begin());
  document.redo.clear();
}

/// Restores the last step of `from` and appends the current one to `to`. A note on the change that
/// is undone would be wrong now, so it vanishes.
void step_back(WorkbenchState& state, std::vector<UndoStep>& from, std::vector<UndoStep>& to) {
  if (from.empty()) return;
  Document& document = state.document;
  if (state.messages.severity == Severity::note) state.messages.text.clear();
  to.push_back(document);
  static_cast<UndoStep&>(document) = from.back();
  from.pop_back();
  document.drag = 0;
}

/// Begins a step of `undo` unless the change continues the drag of the last one.
void begin_step(Document& document, double drag) {
  if (drag == 0 || drag != document.drag || document.undo.empty()) push_undo(document);
  document.drag = drag;
  document.redo.clear();
}

/// Removes what belongs to the reference frame `before.start` from settings with another one: the
/// ids of excluded tracks, and the areas of masks, whose content is elsewhere in another image.
void leave_reference_frame(WorkbenchState& state, Settings& settings, const Settings& before) {
  const auto masks = before.mask.areas.size();
  if (masks > 0 && state.document.settings.mask == before.mask)
    say(state,
        counted(masks, "mask") + " of frame " + std::to_string(before.start) +
            " removed: the window starts elsewhere. Ctrl+Z restores both");
  settings.exclude.clear();
  settings.mask = {};
  state.view.drawn_mask.reset();
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

void retract_error(WorkbenchState& state, const std::string& text) {
  MessageLog& messages = state.messages;
  if (messages.severity == Severity::error && messages.text == text) messages.text.clear();
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
    const Inspection& inspection = *state.results.inspection;
    return !inspection.window->inlier[frame][column] && !is_excluded(inspection, column) &&
           !is_static(inspection, column);
  });
}

std::vector<std::int64_t> tracks_within(const WorkbenchState& state,
                                        const Vector2d& a,
                                        const Vector2d& b) {
  const Eigen::AlignedBox2d box(a.cwiseMin(b), a.cwiseMax(b));
  return tracks_if(state, [&](int frame, int column) {
    return box.contains(state.results.inspection->tracks->raw_px[frame].col(column).eval());
  });
}

std::optional<int> to_main_plane(const Inspection& inspection, std::int64_t id) {
  const Window& window = *inspection.window;
  const auto column = column_of(*inspection.tracks, id);
  const auto plane = column ? window.plane_of(*column) : std::nullopt;
  return plane && *plane != window.leader ? std::optional(*plane + 1) : std::nullopt;
}

std::vector<std::int64_t> tracks_of(std::span<const Finding> findings, const Tracks& tracks) {
  std::vector<std::int64_t> ids;
  for (const Finding& finding : findings)
    std::ranges::copy_if(finding.tracks, std::back_inserter(ids), [&](std::int64_t id) {
      return column_of(tracks, id).has_value();
    });
  std::ranges::sort(ids);
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

std::optional<int> column_of(const Tracks& tracks, std::int64_t id) {
  const auto found = std::ranges::find(tracks.ids, id);
  if (found == tracks.ids.end()) return std::nullopt;
  return static_cast<int>(found - tracks.ids.begin());
}

TimeSpan around_window(const Settings& settings, int frames) {
  const int count = std::max(3 * settings.frames, 2 * kFewest);
  const int margin = (count - settings.frames) / 2;
  return within(settings.start - margin, count, frames);
}

TimeSpan first_time_span(const Settings& settings, int frames) {
  constexpr int kHairline = 50;  // recording's length in windows
  if (frames < kHairline * settings.frames) return {};
  return zoomed(around_window(settings, frames), frames, 0.5, 4);
}

TimeSpan zoomed(const TimeSpan& span, int frames, double share, double factor) {
  const int shown = span.count > 0 ? span.count : frames;
  const int count =
      std::clamp(static_cast<int>(std::lround(shown * factor)), std::min(kFewest, frames), frames);
  return within(span.first + share * (shown - count), count, frames);
}

TimeSpan holding(TimeSpan span, int frame) {
  if (span.count > 0) span.first = std::clamp(span.first, frame - span.count + 1, frame);
  return span;
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
  settings.frames = settings.start <= end - kLeastWindow
                        ? end - settings.start
                        : std::min(settings.frames, frame_count - settings.start);
  return fit_window(settings, frame_count);
}

Settings end_window_at(Settings settings, int frame, int frame_count) {
  const int end = std::clamp(frame + 1, kLeastWindow, std::max(kLeastWindow, frame_count));
  if (end < settings.start + kLeastWindow) settings.start = std::max(0, end - settings.frames);
  settings.start = std::max(settings.start, end - kLongestWindow);
  settings.frames = end - settings.start;
  return fit_window(settings, frame_count);
}

const std::shared_ptr<const Recording>& shown_recording(const WorkbenchState& state) {
  const auto& inspection = state.results.inspection;
  return state.document.recording && inspection ? inspection->recording : state.document.recording;
}

bool is_frozen(const WorkbenchState& state) {
  const auto& recording = state.document.recording;
  return !state.live && recording && recording->layout == kLiveLayout && !state.live_source.empty();
}

void change_settings(WorkbenchState& state, Settings settings, double drag) {
  Document& document = state.document;
  if (document.recording) settings = fit_window(settings, state.frame_count());
  const bool continues = drag != 0 && drag == document.drag && !document.undo.empty();
  const Settings& before = continues ? document.undo.back().settings : document.settings;
  if (settings.start != before.start) {
    leave_reference_frame(state, settings, before);
  } else if (continues) {
    settings.exclude = before.exclude;
    settings.mask = before.mask;
  }
  if (settings == document.settings) return;
  begin_step(document, drag);
  document.settings = std::move(settings);
}

void change_cube_side(WorkbenchState& state, double side, double drag) {
  constexpr double kMost = 2;
  side = std::clamp(side, 0.0, kMost);
  if (side == state.document.cube_side) return;
  begin_step(state.document, drag);
  state.document.cube_side = side;
}

void move_cube(WorkbenchState& state,
               const std::optional<Vector3d>& ray,
               int plane,
               bool dragging) {
  Document& document = state.document;
  UndoStep moved = document;
  if (ray && plane > 0)
    moved.other_cube_rays[plane] = *ray;
  else
    moved.cube_ray = ray;
  if (!ray) moved.other_cube_rays.clear();
  if (moved.cube_ray == document.cube_ray && moved.other_cube_rays == document.other_cube_rays)
    return;
  if (!dragging) push_undo(document);
  document.redo.clear();
  document.drag = 0;
  static_cast<UndoStep&>(document) = std::move(moved);
}

void undo(WorkbenchState& state) { step_back(state, state.document.undo, state.document.redo); }

void redo(WorkbenchState& state) { step_back(state, state.document.redo, state.document.undo); }

bool Selection::contains(std::int64_t track) const {
  return std::ranges::binary_search(tracks, track);
}

Selection selected(std::span<const std::int64_t> tracks) { return extended({}, tracks); }

Selection toggled(Selection selection, std::int64_t track) {
  if (!selection.contains(track)) return extended(selection, {&track, 1});
  std::erase(selection.tracks, track);
  if (selection.focus == track) {
    selection.focus = std::nullopt;
    if (!selection.tracks.empty()) selection.focus = selection.tracks.back();
  }
  return selection;
}

Selection extended(Selection selection, std::span<const std::int64_t> tracks) {
  std::set<std::int64_t> all(selection.tracks.begin(), selection.tracks.end());
  all.insert(tracks.begin(), tracks.end());
  selection.tracks.assign(all.begin(), all.end());
  if (!tracks.empty()) selection.focus = tracks.back();
  return selection;
}

Selection inverted(const Selection& selection, std::span<const std::int64_t> all) {
  std::vector<std::int64_t> others;
  for (const std::int64_t track : all)
    if (!selection.contains(track)) others.push_back(track);
  return selected(others);
}

void pick_point(WorkbenchState& state, const Vector2d& raw_px) {
  Selection& selection = state.selection;
  if (selection.points_px.size() != 1 || selection.points_frame != state.view.frame)
    selection.points_px.clear();
  selection.points_frame = state.view.frame;
  selection.points_px.push_back(raw_px);
  say(state,
      selection.points_px.size() == 1
          ? "first point picked; Alt+click the second one"
          : "two points picked; right-click the image to set their distance or the origin");
}

void close_next(WorkbenchState& state) {
  Panes& panes = state.view.panes;
  if (state.view.drawn_mask)
    state.view.drawn_mask.reset();
  else if (!state.selection.tracks.empty() || !state.selection.points_px.empty())
    state.selection = {};
  else if (panes.beside != nullptr)
    panes.beside = nullptr;
  else
    panes.drawer = nullptr;
}

}  // namespace gpo
