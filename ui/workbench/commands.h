// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/settings/settings.h"
#include "ui/look/orbit_camera.h"
#include "ui/look/zoom.h"
#include "ui/workbench/division.h"
#include "ui/workbench/selection.h"

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace gpo {

struct RunAction {
  std::string line;  ///< a line of a script: an action's name and what it needs, see `run_line`
};
struct ChangeSettings {
  Settings settings;
  bool dragging = false;  ///< one of many small changes: they are undone together
};
struct GoToFrame {
  int frame;
};
struct SetCubeSide {
  double side;
};
/// Puts the cube where the ray of the reference camera meets the plane; nothing: back to its place.
struct MoveCube {
  std::optional<Eigen::Vector3d> ray;
};
struct ZoomImage {
  ImageZoom zoom;
};
/// All columns of the comparison; nothing: around the cubes.
struct ZoomCompare {
  std::optional<ImageZoom> zoom;
};
struct ZoomNormals {
  NormalsZoom zoom;
};
struct OrbitScene {
  OrbitCamera camera;
};
struct FitScene {};
struct DivideWindow {
  Division division;
};
struct OpenPath {
  std::filesystem::path path;
};
struct HoverOver {
  Hover hover;
};
struct SelectTracks {
  Selection selection;
};

/// Everything that a user can do. Panels push commands and change nothing themselves; so keys,
/// menus, panels and tests take one path: `apply`.
using Command = std::variant<RunAction,
                             ChangeSettings,
                             GoToFrame,
                             SetCubeSide,
                             MoveCube,
                             ZoomImage,
                             ZoomCompare,
                             ZoomNormals,
                             OrbitScene,
                             FitScene,
                             DivideWindow,
                             OpenPath,
                             HoverOver,
                             SelectTracks>;

/// What the user did while a frame was drawn, to be applied after it.
using Commands = std::vector<Command>;
/// Not `push_back`: inlined, it makes GCC 12 warn of members that are not there.
void push(Commands& commands, const Command& command);

}  // namespace gpo
