// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/actions/tables.h"

#include <algorithm>

#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace gpo {
namespace {

using State = WorkbenchState;

void add_undo(const MenuRows& menu) {
  Action& undo = menu.plain(
      {"undo", "Undo", "Undoes the last change of settings, excluded tracks or cube position"},
      gpo::undo);
  undo.shortcuts = {control('Z')};
  undo.value = [](const State& s) { return std::to_string(s.document.undo.size()); };
  Action& redo = menu.plain({"redo", "Redo", "Repeats the change that was undone"}, gpo::redo);
  redo.shortcuts = {control('Y')};
  redo.value = [](const State& s) { return std::to_string(s.document.redo.size()); };
  menu.plain({"reset-cube", "Reset the cube position", "Moves the cube back to its default place"},
             [](State& s) { move_cube(s, std::nullopt); });
}

void select_track(State& state, const Arguments& arguments) {
  const std::int64_t id = arguments.whole_number();
  if (!std::ranges::binary_search(tracks_of_window(state), id))
    throw InputError(fmt::format("select track: the window has no track {}", id));
  state.selection = extended(state.selection, {&id, 1});
}

void select_rectangle(State& state, const Arguments& a) {
  const std::vector<std::int64_t> within =
      tracks_within(state, {a.number(0), a.number(1)}, {a.number(2), a.number(3)});
  state.selection = selected(within);
}

void add_selection(const MenuRows& menu) {
  menu.add({"select track", "Select a track", "Selects a track by its id"}, "ID", select_track);
  menu.add({"select rectangle",
            "Select the tracks in a rectangle",
            "Selects the tracks of the current frame in a rectangle of the image [px]"},
           "LEFT TOP RIGHT BOTTOM",
           select_rectangle);
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

void exclude_selected(State& state) {
  if (state.selection.tracks.empty()) throw InputError("no track is selected");
  Settings settings = state.document.settings;
  auto& out = settings.exclude;
  out.insert(out.end(), state.selection.tracks.begin(), state.selection.tracks.end());
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  say(state,
      fmt::format("{} track{} excluded; Ctrl+Z undoes it", out.size(), out.size() == 1 ? "" : "s"));
  change_settings(state, settings);
}

void add_exclusion(const MenuRows& menu) {
  menu.plain({"exclude",
              "Exclude the selected tracks",
              "Excludes the selected tracks and computes again"},
             exclude_selected)
      .shortcuts = {key(GLFW_KEY_DELETE, "Del")};
  menu.plain({"include", "Restore excluded tracks", "Uses all tracks again and computes again"},
             [](State& s) {
               Settings settings = s.document.settings;
               settings.exclude.clear();
               change_settings(s, settings);
             });
}

}  // namespace

void add_edit_actions(std::vector<Action>& table) {
  const MenuRows menu{table, "Edit"};
  add_undo(menu);
  add_selection(menu);
  add_exclusion(menu);
}

}  // namespace gpo
