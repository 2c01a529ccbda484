// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The menu Edit, except for points: undo, selection, tracks, masks, and the clipboard.
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

void add_undo(const MenuRows& menu) {
  Action& undo =
      menu.plain({"undo",
                  "Undo",
                  "Undoes the last change to settings, excluded tracks, cube side or position"},
                 gpo::undo);
  undo.shortcuts = {control('Z')};
  undo.value = [](const State& s) { return std::to_string(s.document.undo.size()); };
  Action& redo = menu.plain({"redo", "Redo", "Reapplies the change that was undone"}, gpo::redo);
  redo.shortcuts = {control('Y')};
  redo.value = [](const State& s) { return std::to_string(s.document.redo.size()); };
  menu.plain(
      {"reset-cube", "Reset the cube position", "Moves the cubes back to their default places"},
      [](State& s) { move_cube(s, std::nullopt); });
}

void add_selection(const MenuRows& menu) {
  menu.add({"select track", "Select a track", "Selects a track by its id"},
           "ID",
           [](State& s, const Arguments& a) {
             s.selection = extended(s.selection, tracks_named(s, a));
           });
  menu.add({"select rectangle",
            "Select the tracks in a rectangle",
            "Selects the tracks of the current frame in a rectangle of the image [px]"},
           "LEFT TOP RIGHT BOTTOM",
           [](State& s, const Arguments& a) {
             s.selection =
                 selected(tracks_within(s, {a.number(0), a.number(1)}, {a.number(2), a.number(3)}));
           });
  menu.plain({"select outliers",
              "Select the outliers",
              "Selects the tracks that are outliers in the current frame"},
             [](State& s) { s.selection = selected(outliers_in_view(s)); });
  menu.plain({"select invert",
              "Invert the selection",
              "Selects the tracks of the current frame that are not selected"},
             [](State& s) { s.selection = inverted(s.selection, tracks_in_view(s)); })
      .shortcuts = {control('I')};
  menu.plain({"select none", "Select nothing", "Clears the selection"},
             [](State& s) { s.selection = {}; });
}

/// Without a number, of the track selected last.
void choose_main_plane(State& state, const Arguments& arguments) {
  Settings settings = state.document.settings;
  const auto& inspection = state.results.inspection;
  if (!arguments.empty()) {
    settings = with_setting(settings, "plane", arguments[0], state.methods);
    const int planes = inspection ? static_cast<int>(inspection->window->planes.size()) : 0;
    if (planes > 0 && settings.options.plane > planes)
      throw InputError(
          fmt::format("main-plane: {}, the window has {}", arguments[0], counted(planes, "plane")));
  } else {
    const auto& focus = state.selection.focus;
    if (!focus) throw InputError("main-plane: no track is selected");
    const auto plane = inspection ? to_main_plane(*inspection, *focus) : std::nullopt;
    if (!plane) throw InputError(fmt::format("main-plane: track {} is on no other plane", *focus));
    settings.options.plane = *plane;
  }
  change_settings(state, settings);
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

/// Returns the effect on the tracks of the current window, for people; empty if it is unknown.
std::string effect_of(const State& state, const Mask& mask) {
  const auto& inspection = state.results.inspection;
  if (!inspection || inspection->tracks->raw_px.empty() ||
      inspection->tracks->start != state.document.settings.start)
    return "";
  const Tracks& tracks = *inspection->tracks;
  int inside = 0;
  for (int j = 0; j < tracks.track_count(); ++j)
    inside += mask.contains(tracks.raw_px[0].col(j)) ? 1 : 0;
  return counted(inside, "track") + (mask.kind == MaskKind::leave_out
                                         ? " left out"
                                         : " may be on plane 1, all others may not");
}

/// Without pixels the mouse draws the mask.
void add_mask(State& state, MaskKind kind, const Arguments& arguments) {
  if (arguments.empty()) {
    go_to_frame(state, state.document.settings.start);
    state.view.drawn_mask = Mask{kind};
    return;
  }
  Mask mask{kind};
  for (std::size_t i = 0; i < arguments.size(); i += 2)
    mask.corners_raw_px.emplace_back(arguments.number(i), arguments.number(i + 1));
  const std::string before = setting_text(state.document.settings, "mask");
  const std::string after =
      (state.document.settings.mask.areas.empty() ? "" : before + "/") + mask.text();
  Settings settings = with_setting(state.document.settings, "mask", after);
  state.view.drawn_mask.reset();
  const std::string effect = effect_of(state, mask);
  say(state, "mask added" + (effect.empty() ? "" : ": " + effect) + "; Ctrl+Z undoes it");
  change_settings(state, std::move(settings));
}

void remove_masks(State& state) {
  state.view.drawn_mask.reset();
  const auto count = state.document.settings.mask.areas.size();
  if (count == 0) throw InputError("mask off: there are no masks");
  say(state, counted(count, "mask") + " removed; Ctrl+Z undoes it");
  change_settings(state, with_default(state.document.settings, "mask"));
}

}  // namespace

void add_edit_actions(std::vector<Action>& table) {
  const MenuRows menu{table, "Edit"};
  add_undo(menu);
  add_selection({table, "Edit", "Select"});
  menu.add({"main-plane",
            "Make this the main plane",
            "Makes the plane of the selected track, or that of a number, the leading one and "
            "computes again"},
           "[PLANE]",
           choose_main_plane);
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
  add_single_track({table, "Edit", "Track"});
  menu.add(
      {"put-cube",
       "Put a cube",
       "Moves a cube: the one of the plane that a pixel X Y of the current frame shows, or to "
       "where a ray X Y Z of the reference camera (x right, y down, z forward) meets a plane of "
       "the window, without a number the leading one"},
      "X Y [Z [PLANE]]",
      put_cube);
  menu.anytime().add({"copy", "Copy a text", "Copies a text to the clipboard"},
                     "TEXT ...",
                     [](State& s, const Arguments& a) {
                       s.requests.copied = fmt::format("{}", fmt::join(a.words, " "));
                       say(s, "copied " + *s.requests.copied);
                     });
}

void add_mask_actions(std::vector<Action>& table) {
  const MenuRows menu{table, "Edit", "Masks"};
  menu.add({"mask not",
            "Leave out an area",
            "Leaves out the tracks in an area of the reference frame: a dragged rectangle, or a "
            "polygon of clicked corners; in scripts pixels of the recorded, distorted image"},
           "[X1 Y1 X2 Y2 ...]",
           [](State& s, const Arguments& a) { add_mask(s, MaskKind::leave_out, a); });
  menu.add({"mask plane",
            "Draw the area of the main plane",
            "Finds plane 1 only among the tracks in an area of the reference frame, and further "
            "planes only outside of it; drawn and written as for mask not"},
           "[X1 Y1 X2 Y2 ...]",
           [](State& s, const Arguments& a) { add_mask(s, MaskKind::plane, a); });
  menu.plain({"mask off", "Remove all masks", "Removes all masks and computes again"},
             remove_masks);
}

}  // namespace gpo
