// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/files/json_text.h"
#include "engine/files/output_file.h"
#include "engine/inspection/plane_names.h"
#include "engine/inspection/report/camera_path.h"
#include "engine/inspection/report/result_json.h"
#include "engine/inspection/report/result_text.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/actions/tables.h"
#include "ui/workbench/session/recent_files.h"
#include "ui/workbench/session/script.h"
#include "ui/workbench/session/session_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using State = WorkbenchState;

/// FILE [VIEW] [WxH]
void take_screenshot(State& state, const Arguments& arguments) {
  expect_count("screenshot", arguments, 1, 3);
  Screenshot shot{arguments[0]};
  if (shot.file.extension() != ".png")
    throw InputError(fmt::format("screenshot: '{}', expected a file name that ends in .png",
                                 shot.file.string()));
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const bool size = std::isdigit(static_cast<unsigned char>(arguments[i].front())) != 0;
    if (size)
      shot.size = image_size(arguments[i], "screenshot");
    else
      shot.view = arguments[i];
  }
  state.requests.screenshots.push_back(shot);
}

/// FILE [FPS]
void export_video(State& state, const Arguments& arguments) {
  expect_count("export-video", arguments, 1, 2);
  MovieRequest movie{arguments[0]};
  if (movie.file.extension() != ".mp4")
    throw InputError(fmt::format("export-video: '{}', expected a file name that ends in .mp4",
                                 movie.file.string()));
  if (arguments.size() > 1) movie.rate_hz = number_in("export-video", arguments, 1);
  if (arguments.size() > 1 && !(movie.rate_hz >= 1 && movie.rate_hz <= 240))
    throw InputError(
        fmt::format("export-video: '{}', expected 1 to 240 frames a second", arguments[1]));
  if (state.requests.movie) throw InputError("export-video: another movie is being written");
  check_writable(movie.file);
  state.requests.movie = movie;
}

/// A file of the current inspection.
Action export_of(const std::string& what, std::string title, std::string (*text)(const State&)) {
  Action action{"export " + what, std::move(title), "File", {}, ""};
  action.submenu = "Export";
  action.tooltip = "Writes what is shown: the same as `gpo-inspector run` writes";
  action.arguments = "FILE";
  action.run = [what, text](State& state, const Arguments& arguments) {
    expect_count(("export " + what).c_str(), arguments, 1, 1);
    if (!state.results.inspection)
      throw InputError("nothing is computed yet that could be written");
    check_writable(arguments[0]);
    write_file(arguments[0], text(state));
    say(state, "saved " + arguments[0]);
  };
  return action;
}

/// Camera poses of the current inspection: FILE [tum|euroc|kitti]
Action trajectory_export(const std::string& what,
                         std::string title,
                         std::string tooltip,
                         CameraPath (*path)(const State&)) {
  Action action{"export " + what, std::move(title), "File", {}, std::move(tooltip)};
  action.submenu = "Export";
  action.arguments = "FILE [tum|euroc|kitti]";
  action.run = [what, path](State& state, const Arguments& arguments) {
    expect_count(("export " + what).c_str(), arguments, 1, 2);
    if (!state.results.inspection)
      throw InputError("nothing is computed yet that could be written");
    const auto format =
        arguments.size() > 1 ? choice<TrajectoryFormat>(arguments[1]) : TrajectoryFormat::tum;
    check_writable(arguments[0]);
    write_file(arguments[0], to_text(path(state), format));
    say(state, "saved " + arguments[0]);
  };
  return action;
}

std::string whole_result(const State& state) {
  return json_text(to_json(*state.results.inspection), 2);
}

std::optional<double> unit_of(const State& state) {
  return state.document.metric ? std::optional(meters_a_unit(*state.results.inspection))
                               : std::nullopt;
}
std::string points(const State& state) { return to_ply(*state.results.inspection, unit_of(state)); }
CameraPath poses(const State& state) {
  return estimated_path(*state.results.inspection, unit_of(state));
}
CameraPath true_poses(const State& state) { return true_path(*state.results.inspection); }

/// ACTION [PATH]: what is shown at first, or the folder of what is open.
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
  const std::filesystem::path folder =
      opens ? state.document.recording->path.parent_path() : std::filesystem::current_path(none);
  wanted.text = (std::filesystem::absolute(folder, none) / "").string();
  if (arguments.size() > 1) wanted.text = arguments[1];
  state.view.palette.reset();
  state.view.browse = wanted;
}

void add_browse(std::vector<Action>& table) {
  Action action{
      "browse",
      "Open",
      "File",
      {control('O')},
      "Chooses a recording, session or results.csv to open; or a file for another action"};
  action.arguments = "[ACTION [PATH]]";
  action.run = browse;
  action.needs_recording = false;
  action.opens_field = true;
  table.push_back(action);
}

void add_open(std::vector<Action>& table) {
  Action open{"open",
              "Open a path",
              "File",
              {},
              "Opens a recording (a folder or a file), a session, or "
              "a results.csv of `evaluate`"};
  open.arguments = "PATH";
  open.needs_recording = false;
  open.run = [](State& state, const Arguments& arguments) {
    expect_count("open", arguments, 1, 1);
    state.requests.open = arguments[0];
  };
  table.push_back(open);
  table.push_back(anytime(plain("open-example",
                                "Open the example",
                                "File",
                                {},
                                "Opens the recording that comes with the program",
                                [](State& s) { s.requests.open_example = true; })));
}

/// Without a name: where it was saved before; the first time the window asks.
void save_session(State& state, const Arguments& arguments) {
  expect_count("save-session", arguments, 0, 1);
  std::filesystem::path file =
      arguments.empty() ? state.files.session_file : std::filesystem::path(arguments[0]);
  if (file.empty()) file = state.document.recording->name + ".session.json";
  if (arguments.empty() && state.files.session_file.empty() && state.files.asks) {
    state.view.browse = Browse{"save-session", std::filesystem::absolute(file).string()};
    return;
  }
  if (file.extension() != ".json")
    throw InputError(
        fmt::format("save-session: '{}', expected a file name that ends in .json", file.string()));
  check_writable(file);
  write_file(file, session_text(state));
  state.files.session_file = std::filesystem::absolute(file);
  say(state, "saved " + state.files.session_file.string());
}

void add_sessions(std::vector<Action>& table) {
  Action save{"save-session",
              "Save the session",
              "File",
              {control('S')},
              "Writes what is open, chosen and selected into a file that `open` reads; again: into "
              "the same file"};
  save.arguments = "[FILE]";
  save.run = save_session;
  table.push_back(save);
  table.push_back(anytime(plain("continue",
                                "Continue the last session",
                                "File",
                                {},
                                "Opens what was open when the program was closed",
                                [](State& s) {
                                  if (!std::filesystem::exists(last_session_file()))
                                    throw InputError("no session was closed yet");
                                  s.requests.open = last_session_file();
                                })));
}

}  // namespace

void add_file_actions(std::vector<Action>& table) {
  add_browse(table);
  add_open(table);
  add_sessions(table);
  table.push_back(
      plain("save-picture",
            "Save the picture",
            "File",
            {letter('S')},
            "Writes the current frame with its overlays as a PNG into the current folder",
            [](State& s) {
              s.requests.screenshots.push_back({"", "picture"});
            }));
  Action screenshot{"screenshot",
                    "Save a view as a picture",
                    "File",
                    {},
                    fmt::format("Writes the window, or one view alone, as a PNG of any size: {}",
                                fmt::join(pane_names(), ", "))};
  screenshot.arguments = "FILE [VIEW] [WxH]";
  screenshot.needs_recording = false;
  screenshot.run = take_screenshot;
  table.push_back(screenshot);
  Action video{"export-video",
               "Export a movie (MP4)",
               "File",
               {},
               "Writes the window's frames with what is drawn over them, in the recording's own "
               "size and rate; in compare mode the columns side by side"};
  video.arguments = "FILE [FPS]";
  video.run = export_video;
  table.push_back(video);
  table.push_back(trajectory_export("trajectory",
                                    "Export camera poses",
                                    "Writes the estimated camera poses, for evo and others",
                                    poses));
  table.push_back(trajectory_export("true-trajectory",
                                    "Export true camera poses",
                                    "Writes the true camera poses of the window's frames",
                                    true_poses));
  table.push_back(export_of("points", "Export map points (PLY)", points));
  table.push_back(export_of("result", "Export the whole result (JSON)", whole_result));
  Action metric = toggle("metric",
                         "Export in meters",
                         {},
                         "Camera poses and map points are written in meters, by the accelerometer; "
                         "otherwise in distances of the plane",
                         [](State& s) -> bool& { return s.document.metric; });
  metric.menu = "File";
  table.push_back(metric);
  table.push_back(
      anytime(plain("quit", "Quit", "File", {control('Q')}, "Closes the window", [](State& s) {
        s.requests.quit = true;
      })));
}

}  // namespace gpo
