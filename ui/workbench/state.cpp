// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/state.h"

#include <algorithm>
#include <iterator>
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

Compared compared(const WorkbenchState& state, const Settings& settings) {
  Compared one{name_among_compared(state, settings), settings};
  if (const Surveyed* found = find_surveyed(state.results.surveyed.get(), one.settings)) {
    one.inspection = found->inspection;
    one.error = found->error;
  }
  // Equal settings may be written differently: a default left out or written out.
  if (!one.inspection && state.results.inspection &&
      as_used(state.results.inspection->settings) == as_used(settings))
    one.inspection = state.results.inspection;
  return one;
}

Compared current_result(const WorkbenchState& state) {
  const Settings& settings = state.document.settings;
  const auto& latest = state.results.inspection;
  return {name_among_compared(state, settings),
          settings,
          latest && latest->settings == settings ? latest : nullptr};
}

/// The ray on which all cubes are placed, in the reference camera.
std::optional<Vector3d> common_ray(const WorkbenchState& state, const std::vector<Compared>& all) {
  if (state.document.cube_ray) return state.document.cube_ray;
  for (const Compared& one : all) {
    if (!one.inspection || !one.inspection->cube) continue;
    // On a board all cubes have the same corners.
    if (one.inspection->cube->on_board) return std::nullopt;
    return one.inspection->cube->origin;
  }
  return std::nullopt;
}

void place_cubes_alike(const WorkbenchState& state, std::vector<Compared>& all) {
  const auto ray = common_ray(state, all);
  for (Compared& one : all)
    one.inspection = with_cube(one.inspection, ray, state.document.other_cube_rays);
}

std::vector<Compared> unmoved_results(const WorkbenchState& state) {
  std::vector<Compared> all;
  for (const Settings& settings : compared_settings(state, state.document.settings))
    all.push_back(compared(state, settings));
  return all;
}

/// Settings to which the image flips: the first that differ. nullopt: `flip` is off, or none do.
std::optional<Settings> flipped_settings(const WorkbenchState& state) {
  const Configuration current = name_among_compared(state, state.document.settings);
  if (state.view.flip)
    for (const Settings& one : compared_settings(state, state.document.settings))
      if (name_among_compared(state, one) != current) return one;
  return std::nullopt;
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
    return !inspection.window->inlier[frame][column] && !is_excluded(inspection, column);
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

std::shared_ptr<const Inspection> with_cube(std::shared_ptr<const Inspection> inspection,
                                            const std::optional<Vector3d>& ray_c,
                                            const std::map<int, Vector3d>& others_c) {
  if (!inspection || (!ray_c && others_c.empty())) return inspection;
  Inspection moved = *inspection;
  if (ray_c) move_cubes(moved, *ray_c);
  for (const auto& [plane, ray] : others_c) move_cubes(moved, ray, plane - 1);
  return std::make_shared<const Inspection>(std::move(moved));
}

Configuration name_among_compared(const WorkbenchState& state, const Settings& settings) {
  return configuration_of(settings, base_of(state.document.compared, state.document.settings));
}

std::vector<Settings> compared_settings(const WorkbenchState& state, const Settings& window) {
  const std::vector<Configuration>& list = state.document.compared;
  const Settings base = base_of(list, window);
  std::vector<Settings> all;
  for (const Configuration& one : list) all.push_back(apply(one, base));
  return all;
}

std::vector<Settings> settings_with_current(const WorkbenchState& state, const Settings& window) {
  std::vector<Settings> all = compared_settings(state, window);
  const Configuration current = name_among_compared(state, window);
  const auto is_current = [&](const Settings& one) {
    return name_among_compared(state, one) == current;
  };
  if (std::ranges::none_of(all, is_current)) all.insert(all.begin(), window);
  return all;
}

std::vector<Compared> compared_results(const WorkbenchState& state) {
  std::vector<Compared> all = compared_with_current(state);
  place_cubes_alike(state, all);
  if (state.view.flip && all.size() > 1) std::swap(all[0], all[1]);
  return all;
}

std::vector<Compared> compared_with_current(const WorkbenchState& state) {
  std::vector<Compared> all = unmoved_results(state);
  Compared current = current_result(state);
  if (std::ranges::find(all, current.configuration, &Compared::configuration) == all.end())
    all.insert(all.begin(), std::move(current));
  return all;
}

std::optional<Compared> flipped_result(const WorkbenchState& state) {
  const auto other = flipped_settings(state);
  if (!other) return std::nullopt;
  // The cube is placed where the current result has it.
  std::vector<Compared> both = {current_result(state), compared(state, *other)};
  place_cubes_alike(state, both);
  return both.back();
}

std::vector<int> curve_lengths(int frames) {
  constexpr int kStep = 5;
  std::vector<int> lengths = {frames};
  for (int shorter = (frames - 1) / kStep * kStep; shorter >= kStep; shorter -= kStep)
    lengths.push_back(shorter);
  return lengths;
}

std::vector<Settings> wanted_inspections(const WorkbenchState& state) {
  std::vector<Settings> wanted = orientation_settings(state);
  if (!state.document.recording) return wanted;
  PaneNeeds needs = needs_of(state.view.panes);
  if (wants_report(state)) needs.compared = needs.lengths = true;
  if (!needs.compared) {
    if (const auto other = flipped_settings(state)) wanted.push_back(*other);
    return wanted;
  }
  const auto want_each = [&](int frames) {
    Settings window = state.document.settings;
    window.frames = frames;
    std::ranges::copy(settings_with_current(state, window), std::back_inserter(wanted));
  };
  want_each(state.document.settings.frames);
  // The longest window first: the shorter ones reuse its tracks.
  for (const int frames : curve_lengths(state.document.settings.frames))
    if (needs.lengths && frames < state.document.settings.frames) want_each(frames);
  return wanted;
}

bool is_frozen(const WorkbenchState& state) {
  const auto& recording = state.document.recording;
  return !state.live && recording && recording->layout == kLiveLayout && !state.live_source.empty();
}

std::vector<ShownResult> shown_results(const WorkbenchState& state) {
  std::vector<ShownResult> shown;
  if (!state.results.inspection) return shown;
  const Settings& s = state.results.inspection->settings;
  const auto add = [&](const Settings& settings, std::shared_ptr<const Inspection> inspection) {
    const Configuration one = name_among_compared(state, settings);
    shown.push_back({title_of(one), color_of(one), std::move(inspection), shown.empty()});
  };
  add(s, state.results.inspection);
  for (const Settings& settings : compared_settings(state, s)) {
    if (as_used(settings) == as_used(s)) continue;
    const Surveyed* surveyed = find_surveyed(state.results.surveyed.get(), settings);
    if (surveyed != nullptr && surveyed->inspection) add(settings, surveyed->inspection);
  }
  return shown;
}

}  // namespace gpo
