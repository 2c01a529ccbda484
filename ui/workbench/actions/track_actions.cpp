// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Actions on single tracks, on the cube and on the clipboard, most of which context menus offer.
#include "engine/base/error.h"
#include "engine/inspection/studies/studies.h"
#include "ui/workbench/actions/actions.h"

#include <algorithm>
#include <sstream>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using State = WorkbenchState;

/// Returns the tracks with the ids, or those selected if there are no ids.
std::vector<std::int64_t> tracks_named(const State& state, const Arguments& arguments) {
  if (arguments.empty() && state.selection.tracks.empty()) throw InputError("no track is selected");
  if (arguments.empty()) return state.selection.tracks;
  const std::vector<std::int64_t> known = tracks_of_window(state);
  std::vector<std::int64_t> ids;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    ids.push_back(arguments.whole_number(i));
    if (!std::ranges::binary_search(known, ids.back()))
      throw InputError(fmt::format("{}: the window has no track {}", arguments.action, ids.back()));
  }
  std::ranges::sort(ids);
  return ids;
}

/// Without an id, the life of the track selected last.
TrackLife life_named(const State& state, const Arguments& arguments) {
  const std::int64_t last = tracks_named(state, arguments).back();
  const std::int64_t id = arguments.empty() ? state.selection.focus.value_or(last) : last;
  const auto& inspection = state.results.inspection;
  const auto column = inspection ? column_of(*inspection->tracks, id) : std::nullopt;
  TrackLife life = column ? track_life(*inspection, *column) : TrackLife{};
  if (life.frames.empty())
    throw InputError(fmt::format("{}: no frame of the window sees track {}", arguments.action, id));
  return life;
}

void explain_track(State& state, const Arguments& arguments) {
  const TrackLife life = life_named(state, arguments);
  state.selection = selected({&life.id, 1});
  run_line(state, "view track");
  say(state, fmt::format("track {}: {}", life.id, life.verdict));
}

/// Copies the lines of one track of the table of all tracks.
void copy_track(State& state, const Arguments& arguments) {
  const TrackLife life = life_named(state, arguments);
  std::istringstream table(tracks_csv(*state.results.inspection));
  std::string line, text;
  std::getline(table, text);
  const std::string id = fmt::format(",{},", life.id);
  while (std::getline(table, line))
    if (line.find(id) == line.find(',')) text += "\n" + line;
  state.requests.copied = text + "\n";
  say(state, fmt::format("copied track {} as CSV", life.id));
}

void exclude(State& state, const Arguments& arguments) {
  Settings settings = state.document.settings;
  settings.exclude = extended({settings.exclude, {}}, tracks_named(state, arguments)).tracks;
  say(state, counted(settings.exclude.size(), "track") + " excluded; Ctrl+Z undoes it");
  change_settings(state, settings);
}

void add_exclusion(const MenuRows& menu) {
  menu.add({"exclude",
            "Exclude the selected tracks",
            "Excludes the selected tracks, or those with these ids, and computes again"},
           "[TRACK ...]",
           exclude)
      .shortcuts = {key(GLFW_KEY_DELETE, "Del")};
  menu.plain({"include", "Restore excluded tracks", "Uses all tracks again and computes again"},
             [](State& s) {
               Settings settings = s.document.settings;
               settings.exclude.clear();
               change_settings(s, settings);
             });
}

void add_single_track(const MenuRows& menu) {
  menu.add({"explain-track",
            "Explain a track",
            "Says why a track is an inlier or was rejected, and shows its whole life"},
           "[TRACK]",
           explain_track);
  menu.add(
      {"first-of-track", "First frame of a track", "Goes to the first frame that sees it"},
      "[TRACK]",
      [](State& s, const Arguments& a) { go_to_frame(s, life_named(s, a).frames.front().frame); });
  menu.add(
      {"last-of-track", "Last frame of a track", "Goes to the last frame that sees it"},
      "[TRACK]",
      [](State& s, const Arguments& a) { go_to_frame(s, life_named(s, a).frames.back().frame); });
  menu.add({"copy-track",
            "Copy a track as CSV",
            "Copies the positions, residuals and reasons for rejection of a track"},
           "[TRACK]",
           copy_track);
}

void put_cube(State& state, const Arguments& arguments) {
  if (arguments.size() == 2) return put_cube_at_pixel(state, arguments);
  const Vector3d ray(arguments.number(0), arguments.number(1), arguments.number(2));
  const int plane = arguments.size() > 3 ? arguments.whole_number(3) : 0;
  const auto& inspection = state.results.inspection;
  if (!inspection || !inspection->initialization->ok)
    throw InputError("put-cube: there is no plane to put it on");
  const int number = plane == 0 ? inspection->window->leader : plane - 1;
  const Plane* on = estimated_plane(*inspection, number);
  if (on == nullptr) throw InputError(fmt::format("put-cube: plane {} has no estimate", plane));
  if (!ray.allFinite() || !intersect(*on, inspection->initialization->cameras.front(), ray))
    throw InputError(
        fmt::format("put-cube: {} is not in this direction", plane_title(*inspection, number)));
  move_cube(state, ray, number == inspection->window->leader ? 0 : number + 1);
}

}  // namespace

void add_track_actions(std::vector<Action>& table) {
  add_exclusion({table, "Edit"});
  const MenuRows menu{table, "Edit", "Track"};
  add_single_track(menu);
  MenuRows{table, "Edit"}.add(
      {"put-cube",
       "Put a cube",
       "Moves a cube: the one of the plane that a pixel X Y of the current frame shows, or to "
       "where "
       "a ray X Y Z of the reference camera (x right, y down, z forward) meets a plane of the "
       "window, without a number the leading one"},
      "X Y [Z [PLANE]]",
      put_cube);
  MenuRows{table, "Edit"}.anytime().add({"copy", "Copy a text", "Copies a text to the clipboard"},
                                        "TEXT ...",
                                        [](State& s, const Arguments& a) {
                                          s.requests.copied =
                                              fmt::format("{}", fmt::join(a.words, " "));
                                          say(s, "copied " + *s.requests.copied);
                                        });
}

}  // namespace gpo
