// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace gpo {

struct RunAction {
  std::string line;  ///< a line of a script: an action's name and arguments, see `run_line`
};
struct ChangeSettings {
  Settings settings;
  bool dragging = false;  ///< one of many small changes, which are undone together
};
struct GoToFrame {
  int frame;
};
struct SetCubeSide {
  double side;
};
/// Moves the cube to where the ray of the reference camera meets the plane; nullopt: to its default
/// place.
struct MoveCube {
  std::optional<Eigen::Vector3d> ray;
};
struct ZoomImage {
  ImageZoom zoom;
};
/// Zooms all columns of the comparison; nullopt: around the cubes.
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

/// Everything a user can do. Panels only push commands and change nothing themselves, so that keys,
/// menus, panels and tests all go through `apply`.
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

/// Commands collected while a frame is drawn, to be applied after it.
using Commands = std::vector<Command>;
/// Appends a command. Not inlined: GCC 12 warns about uninitialized members of the variant.
void push(Commands& commands, const Command& command);

void apply(WorkbenchState& state, const Command& command);

}  // namespace gpo
