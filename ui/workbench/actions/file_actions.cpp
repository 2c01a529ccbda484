// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/exports/exports.h"
#include "engine/files/output_file.h"
#include "engine/files/text_file.h"
#include "engine/inspection/report/report.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/session/session_file.h"
#include "ui/workbench/work/writers.h"

#include <algorithm>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using State = WorkbenchState;

void expect_extension(const std::string& action, const fs::path& file, const char* extension) {
  if (file.extension() != extension)
    throw InputError(fmt::format(
        "{}: '{}', expected a file name that ends in {}", action, file.string(), extension));
}

void take_screenshot(State& state, const Arguments& arguments) {
  Screenshot shot{arguments[0]};
  expect_extension(arguments.action, shot.file, ".png");
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const bool size = std::isdigit(static_cast<unsigned char>(arguments[i].front())) != 0;
    if (size)
      shot.size = image_size(arguments[i], "screenshot");
    else
      shot.view = arguments[i];
  }
  state.requests.screenshots.push_back(shot);
}

void export_video(State& state, const Arguments& arguments) {
  MovieRequest movie{arguments[0]};
  expect_extension(arguments.action, movie.file, ".mp4");
  if (arguments.size() > 1) movie.rate_hz = arguments.number(1);
  if (arguments.size() > 1 && !(movie.rate_hz >= 1 && movie.rate_hz <= 240))
    throw InputError(
        fmt::format("export-video: '{}', expected 1 to 240 frames per second", arguments[1]));
  if (state.requests.movie) throw InputError("export-video: another movie is being written");
  check_writable(movie.file);
  state.requests.movie = movie;
}

void write_text(State& state, const fs::path& file, const std::string& text) {
  check_writable(file);
  write_file(file, text);
  say(state, "saved " + file.string());
}

ExportWorld world_of(const State& state) {
  return export_world(*state.results.inspection, state.document.metric);
}

std::string path_text(const CameraPath& path, const Arguments& arguments) {
  return to_text(
      path, arguments.size() > 1 ? choice<TrajectoryFormat>(arguments[1]) : TrajectoryFormat::tum);
}

/// `export FORMAT PATH`: one command for each format, and one that lists them for an unknown one.
void add_export_formats(const MenuRows& menu) {
  for (const ExportFormat& format : export_formats())
    menu.add({fmt::format("export {}", format.key),
              fmt::format("Export: {}", format.title),
              format.help},
             "PATH",
             [&format](State& state, const Arguments& given) {
               request_export(state, format, given[0]);
             });
  menu.add({"export", "Export in a format", "Writes the result in a format, by its name"},
           "FORMAT PATH",
           [](State& state, const Arguments& given) {
             request_export(state, export_format(given[0]), given[1]);
           });
}

void add_exports(const MenuRows& menu) {
  const auto add = [&](Action action,
                       const char* arguments,
                       std::string (*text)(const State&, const Arguments&)) {
    menu.add(std::move(action), arguments, [text](State& state, const Arguments& given) {
      if (!state.results.inspection) throw InputError("no result to export yet");
      write_text(state, given[0], text(state, given));
    });
  };
  add({"export trajectory",
       "Export camera poses",
       "Writes the estimated camera poses, for evo and other tools"},
      "FILE [tum|euroc|kitti]",
      [](const State& s, const Arguments& a) {
        return path_text(estimated_path(*s.results.inspection, world_of(s)), a);
      });
  add({"export true-trajectory",
       "Export true camera poses",
       "Writes the true camera poses of the window's frames"},
      "FILE [tum|euroc|kitti]",
      [](const State& s, const Arguments& a) {
        return path_text(true_path(*s.results.inspection), a);
      });
  const char* help = "Writes the current result, as `gpo-inspector run` does";
  add({"export points", "Export map points (PLY)", help},
      "FILE",
      [](const State& s, const Arguments&) {
        return map_points_ply(*s.results.inspection, world_of(s));
      });
  add({"export result", "Export the whole result (JSON)", help},
      "FILE",
      [](const State& s, const Arguments&) {
        return json_text(to_json(*s.results.inspection), 2);
      });
  add_export_formats(menu);
}

/// Begins in the given path, else in the folder of the open recording or in the current one.
void browse(State& state, const Arguments& arguments) {
  Browse wanted;
  if (!arguments.empty()) wanted.action = arguments[0];
  const Action* action = find_action(wanted.action);
  if (action == nullptr || !takes_a_file(*action))
    throw InputError(
        fmt::format("browse: '{}', expected an action that takes a file", wanted.action));
  if (!enabled(*action, state)) throw InputError("no recording is open");
  std::error_code none;
  const bool opens = wanted.action == "open" && state.document.recording;
  const auto folder = opens ? state.document.recording->path.parent_path() : fs::current_path(none);
  wanted.text = (fs::absolute(folder, none) / "").string();
  if (arguments.size() > 1) wanted.text = arguments[1];
  state.view.palette.reset();
  state.view.browse = wanted;
}

void add_open(const MenuRows& menu) {
  Action& browser = menu.add(
      {"browse",
       "Open",
       "Opens a recording, a session or a results.csv, or chooses a file for another action"},
      "[ACTION [PATH]]",
      browse);
  browser.shortcuts = {control('O')};
  browser.opens_field = true;
  menu.add({"open",
            "Open a path",
            "Opens a recording (folder or file), a session or a results.csv of `evaluate`"},
           "PATH",
           [](State& state, const Arguments& arguments) { state.requests.open = arguments[0]; });
  menu.plain({"open-example", "Open the example", "Opens the recording shipped with the program"},
             [](State& s) { s.requests.open_example = true; });
}

/// Saves to the given file, else to the last one; the first time the user is asked.
void save_session(State& state, const Arguments& arguments) {
  if (state.document.recording->layout == kLiveLayout)
    throw InputError("save-session: first save the recording with save-recording and open it");
  fs::path file = arguments.empty() ? state.files.session_file : fs::path(arguments[0]);
  if (file.empty()) file = state.document.recording->name + ".session.json";
  if (arguments.empty() && state.files.session_file.empty() && state.files.asks) {
    state.view.browse = Browse{"save-session", fs::absolute(file).string()};
    return;
  }
  expect_extension(arguments.action, file, ".json");
  write_text(state, fs::absolute(file), session_text(state));
  state.files.session_file = fs::absolute(file);
}

void add_sessions(const MenuRows& menu) {
  menu.add(
          {"save-session",
           "Save the session",
           "Saves recording, settings, view and selection to a file that `open` reads; later saves "
           "go to the same file"},
          "[FILE]",
          save_session)
      .shortcuts = {control('S')};
  menu.anytime().plain({"continue",
                        "Continue the last session",
                        "Opens what was open when the program was last closed"},
                       [](State& s) {
                         if (!fs::exists(last_session_file()))
                           throw InputError("no previous session");
                         s.requests.open = last_session_file();
                       });
}

void add_images(const MenuRows& menu) {
  menu.plain({"save-picture",
              "Save the image",
              "Saves the current frame with its overlays as a PNG in the current folder"},
             [](State& s) {
               s.requests.screenshots.push_back({"", "picture"});
             })
      .shortcuts = {letter('S')};
  menu.anytime().add({"screenshot",
                      "Save a view as an image",
                      fmt::format("Saves the window or one view as a PNG of any size: {}",
                                  fmt::join(pane_names(), ", "))},
                     "FILE [VIEW] [WxH]",
                     take_screenshot);
  menu.add({"report",
            "Write a report (HTML)",
            "Writes one file to send: verdict, images, a scene to turn, and tables of the result"},
           "FILE",
           [](State& state, const Arguments& arguments) {
             expect_extension(arguments.action, arguments[0], ".html");
             if (!state.results.inspection) throw InputError("report: no result to write yet");
             state.requests.screenshots.push_back({arguments[0], kReportView});
           });
  menu.add({"export-video",
            "Export a movie (MP4)",
            "Writes the window's frames with overlays at the size and rate of the recording; in "
            "compare mode the columns side by side"},
           "FILE [FPS]",
           export_video);
}

void add_undo(const MenuRows& menu) {
  Action& undo = menu.plain(
      {"undo", "Undo", "Undoes the last change to settings, excluded tracks or cube position"},
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

void select_track(State& state, const Arguments& arguments) {
  const std::int64_t id = arguments.whole_number();
  if (!std::ranges::binary_search(tracks_of_window(state), id))
    throw InputError(fmt::format("select track: the window has no track {}", id));
  state.selection = extended(state.selection, {&id, 1});
}

void add_selection(const MenuRows& menu) {
  menu.add({"select track", "Select a track", "Selects a track by its id"}, "ID", select_track);
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

void add_main_plane(const MenuRows& menu) {
  menu.add({"main-plane",
            "Make this the main plane",
            "Makes the plane of the selected track, or that of a number, the leading one and "
            "computes again"},
           "[PLANE]",
           choose_main_plane);
}

}  // namespace

void add_file_actions(std::vector<Action>& table) {
  const MenuRows menu{table, "File"};
  add_open(menu.anytime());
  add_live_actions(table);
  add_sessions(menu);
  add_images(menu);
  add_exports({table, "File", "Export"});
  menu.toggle(
      {"metric",
       "Export in meters",
       "Exports camera poses and map points in meters instead of plane distances (always if "
       "two points set the scale)"},
      [](State& s) -> bool& { return s.document.metric; });
  menu.anytime()
      .plain({"quit", "Quit", "Closes the window"}, [](State& s) { s.requests.quit = true; })
      .shortcuts = {control('Q')};
}

void add_edit_actions(std::vector<Action>& table) {
  const MenuRows menu{table, "Edit"};
  add_undo(menu);
  add_selection({table, "Edit", "Select"});
  add_main_plane(menu);
  add_track_actions(table);
}

}  // namespace gpo
