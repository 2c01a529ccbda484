// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "ui/workbench/actions/tables.h"
#include "ui/workbench/tracks_in_view.h"
#include "ui/workbench/undo.h"

#include <algorithm>

#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace gpo {
namespace {

using State = WorkbenchState;

void add_undo(std::vector<Action>& table) {
  Action undo = plain(
      "undo",
      "Undo",
      "Edit",
      {control('Z')},
      "Takes back the last change of the settings, of the excluded tracks or of the cube's place",
      gpo::undo);
  undo.value = [](const State& s) { return std::to_string(s.document.undo.size()); };
  Action redo = plain("redo",
                      "Redo",
                      "Edit",
                      {control('Y')},
                      "Makes the change again that was taken back",
                      gpo::redo);
  redo.value = [](const State& s) { return std::to_string(s.document.redo.size()); };
  table.push_back(undo);
  table.push_back(redo);
  table.push_back(plain("reset-cube",
                        "Put the cube back",
                        "Edit",
                        {},
                        "The cube stands where it comes by itself again",
                        [](State& s) { move_cube(s, std::nullopt); }));
}

void select_track(State& state, const Arguments& arguments) {
  expect_count("select track", arguments, 1, 1);
  const std::int64_t id = whole_number_in("select track", arguments);
  const std::vector<std::int64_t> all = tracks_of_window(state);
  if (!std::ranges::binary_search(all, id))
    throw InputError(fmt::format("select track: the window has no track {}", id));
  state.selection = extended(state.selection, {&id, 1});
}

void select_rectangle(State& state, const Arguments& arguments) {
  expect_count("select rectangle", arguments, 4, 4);
  const auto at = [&](std::size_t i) { return number_in("select rectangle", arguments, i); };
  state.selection = selected(tracks_within(state, {at(0), at(1)}, {at(2), at(3)}));
}

void add_selection(std::vector<Action>& table) {
  Action track{"select track", "Select a track", "Edit", {}, "Picks out a track by its id"};
  track.arguments = "ID";
  track.run = select_track;
  table.push_back(track);
  Action rectangle{"select rectangle",
                   "Select the tracks in a rectangle",
                   "Edit",
                   {},
                   "Picks out the tracks of the current frame in a part of the picture [px]"};
  rectangle.arguments = "LEFT TOP RIGHT BOTTOM";
  rectangle.run = select_rectangle;
  table.push_back(rectangle);
  table.push_back(plain("select outliers",
                        "Select the outliers",
                        "Edit",
                        {},
                        "Picks out the tracks that are outliers in the current frame",
                        [](State& s) { s.selection = selected(outliers_in_view(s)); }));
  table.push_back(plain("select invert",
                        "Invert the selection",
                        "Edit",
                        {control('I')},
                        "Picks out the tracks of the current frame that are not picked, instead",
                        [](State& s) { s.selection = inverted(s.selection, tracks_in_view(s)); }));
  table.push_back(
      plain("select none", "Select nothing", "Edit", {}, "Picks out no track", [](State& s) {
        s.selection = {};
      }));
}

/// Leaves the selected tracks out of the window.
void exclude_selected(State& state) {
  if (state.selection.tracks.empty()) throw InputError("no track is selected");
  Settings settings = state.document.settings;
  auto& out = settings.exclude;
  out.insert(out.end(), state.selection.tracks.begin(), state.selection.tracks.end());
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  say(state, fmt::format("{} tracks are left out; Ctrl+Z takes them back", out.size()));
  change_settings(state, settings);
}

void add_exclusion(std::vector<Action>& table) {
  table.push_back(plain("exclude",
                        "Exclude the selected tracks",
                        "Edit",
                        {key(GLFW_KEY_DELETE, "Del")},
                        "Leaves the selected tracks out and solves again",
                        exclude_selected));
  table.push_back(plain("include",
                        "Take all tracks back",
                        "Edit",
                        {},
                        "Leaves out no track and solves again",
                        [](State& s) {
                          Settings settings = s.document.settings;
                          settings.exclude.clear();
                          change_settings(s, settings);
                        }));
}

}  // namespace

void add_edit_actions(std::vector<Action>& table) {
  add_undo(table);
  add_selection(table);
  add_exclusion(table);
}

}  // namespace gpo
