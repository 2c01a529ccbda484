// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "ui/workbench/actions/actions.h"

#include <fmt/format.h>

namespace gpo {
namespace {

using State = WorkbenchState;

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

}  // namespace

bool is_frozen(const WorkbenchState& state) {
  const auto& recording = state.document.recording;
  return !state.live && recording && recording->layout == kLiveLayout && !state.live_source.empty();
}

void add_live_actions(std::vector<Action>& table) {
  const MenuRows menu{table, "File"};
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

}  // namespace gpo
