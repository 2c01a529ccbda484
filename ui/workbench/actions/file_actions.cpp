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
  check_output(state, shot.file);
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
  check_output(state, movie.file);
  state.requests.movie = movie;
}

void write_text(State& state, const fs::path& file, const std::string& text) {
  check_writable(file);
  check_output(state, file);
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

/// Opens a source, or without an address the list of cameras.
void open_live(State& state, const Arguments& arguments) {
  if (!state.files.asks)
    throw InputError("live: only a user at the window opens cameras and streams, no script");
  if (arguments.empty()) {
    state.view.palette.reset();
    state.view.browse.reset();
    state.view.sources = list_cameras();
    return;
  }
  if (!is_live_address(arguments[0]))
    throw InputError(
        fmt::format("live: '{}', expected camera:0, rtsp://, http:// or udp://", arguments[0]));
  state.view.sources.reset();
  state.requests.live = arguments[0];
}

void freeze(State& state) {
  if (state.live)
    state.requests.freeze = true;
  else if (is_frozen(state))
    state.requests.live = state.live_source;
  else
    throw InputError("freeze: no camera or stream is open");
}

void save_recording(State& state, const Arguments& arguments) {
  if (state.live) throw InputError("save-recording: freeze the images with Space first");
  if (!state.document.recording->images)
    throw InputError("save-recording: the recording has no images");
  state.requests.save_recording = fs::absolute(arguments[0]);
}

void add_live(const MenuRows& menu) {
  Action& live = menu.anytime().add(
      {"live",
       "Open a camera or a stream",
       "Opens camera:0, rtsp://, http:// or udp://; without an address lists the cameras"},
      "[ADDRESS]",
      open_live);
  live.opens_field = true;
  live.opens_device = true;
  Action& freezing = menu.anytime().plain(
      {"freeze",
       "Freeze or continue",
       "Makes the last seconds of a camera or a stream a recording, or continues with live images"},
      freeze);
  freezing.shortcuts = {{.character = U' ', .label = "Space"}};
  freezing.takes_keys = [](const State& s) { return s.live || is_frozen(s); };
  menu.add({"save-recording",
            "Save the recording",
            "Writes the recording as an EuRoC folder, or to a file .bag or .mcap as a ROS bag"},
           "PATH",
           save_recording);
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
             check_output(state, arguments[0]);
             state.requests.screenshots.push_back({arguments[0], kReportView});
           });
  menu.add({"export-video",
            "Export a movie (MP4)",
            "Writes the window's frames with overlays at the size and rate of the recording; in "
            "compare mode the columns side by side"},
           "FILE [FPS]",
           export_video);
}

}  // namespace

void add_file_actions(std::vector<Action>& table) {
  const MenuRows menu{table, "File"};
  add_open(menu.anytime());
  add_live(menu);
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

}  // namespace gpo
