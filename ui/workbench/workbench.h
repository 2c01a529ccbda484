// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/settings.h"
#include "engine/recording/recording.h"
#include "ui/views/image_geometry.h"
#include "ui/views/orbit_camera.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace gpo {

/// What is drawn into picture and scene.
struct ViewToggles {
  bool tracks = true;
  bool tails = true;
  bool residuals = false;
  bool cube = true;
  bool truth = true;
  int uncertainty = 1;  ///< of the scene, enlarged so many times: 0 (not shown), 1, 10, 100
};

/// What an action asks of the world around the workbench: the window's loop reads and clears it.
struct Wishes {
  bool quit = false;
  bool cancel = false;        ///< what the worker does
  bool compute = false;       ///< inspect again with the same settings
  bool save_picture = false;  ///< the picture of the current frame, to disk
  bool open_example = false;
  std::optional<std::filesystem::path> open;
};

/// What the user has open, chosen and selected. A plain value; it changes in `apply`, `advance` and
/// `adopt` alone.
struct WorkbenchState {
  std::shared_ptr<const Recording> recording;  ///< null: nothing is open
  Settings settings;
  int frame = 0;  ///< shown, counts in the recording
  bool playing = false;
  double play_seconds = 0;  ///< since `frame` is shown, while playing
  ViewToggles view;
  double cube_side = 0;              ///< in plane distances; 0: automatic
  PictureZoom picture_zoom;          ///< of the picture
  std::optional<OrbitCamera> orbit;  ///< of the scene; nothing: everything in view
  bool show_help = false;
  std::string message;  ///< the last one, one line
  Wishes wishes;

  int frame_count() const { return recording ? recording->frame_count() : 0; }
};

struct RunAction {
  std::string name;  ///< in `actions()`
};
struct ChangeSettings {
  Settings settings;
};
struct GoToFrame {
  int frame;
};
struct SetCubeSide {
  double side;
};
struct ZoomPicture {
  PictureZoom zoom;
};
struct OrbitScene {
  OrbitCamera camera;
};
struct FitScene {};
struct OpenRecording {
  std::filesystem::path path;
};

/// Everything that a user can do. Panels push commands and change nothing themselves; so keys,
/// menus, panels and tests take one path.
using Command = std::variant<RunAction,
                             ChangeSettings,
                             GoToFrame,
                             SetCubeSide,
                             ZoomPicture,
                             OrbitScene,
                             FitScene,
                             OpenRecording>;

/// What the user did while a frame was drawn, to be applied after it.
using Commands = std::vector<Command>;
/// Not `push_back`: inlined, it makes GCC 12 warn of members that are not there.
void push(Commands& commands, const Command& command);

void apply(WorkbenchState& state, const Command& command);

/// Lets `seconds` pass: plays at the recording's own rate, and stops at its last frame.
void advance(WorkbenchState& state, double seconds);

/// Until `advance` shows another frame [s]; nothing where it will not.
std::optional<double> seconds_to_next_frame(const WorkbenchState& state);

/// Takes a recording that was opened: fits the window into it and shows the window's last frame.
void adopt(WorkbenchState& state, std::shared_ptr<const Recording> recording);

/// The nearest settings whose window fits into so many frames (at least two).
Settings fit_window(Settings settings, int frame_count);

/// The window from `frame` on to its old end, or of its old length where it would end before.
Settings start_window_at(Settings settings, int frame, int frame_count);

/// The window from its old start up to `frame`, or of its old length where it would start after.
Settings end_window_at(Settings settings, int frame, int frame_count);

}  // namespace gpo
