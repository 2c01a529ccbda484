// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

namespace gpo {

/// What is drawn into the views. They read the member; everything else reads its row below.
struct ViewToggles {
  bool tracks = true;
  bool tails = true;
  bool residuals = false;
  bool cube = true;
  bool truth = true;
  bool gravity = true;
  bool undistorted = false;
  bool legend = true;
  bool scan = false;
  bool wireframe = false;
  bool tower = false;
  int uncertainty = 1;    ///< magnification in the scene: 0 (not shown), 1, 10, 100
  int exaggeration = 1;   ///< magnification of the cube's error
  int point_size_px = 5;  ///< of the scene's points, at scale 1

  bool operator==(const ViewToggles&) const = default;
};

/// One switch of `ViewToggles`: actions, keys, menus and sessions read the table.
struct ViewToggle {
  const char* key;    ///< in scripts and sessions
  const char* title;  ///< for people
  char letter;        ///< of the keyboard; 0: none
  bool ViewToggles::*shown;
  const char* tooltip;       ///< one sentence
  const char* submenu = "";  ///< of the menu View; empty: the menu itself
};

inline constexpr const char* kCubeMenu = "Looks of the cube";

// clang-format off
inline constexpr auto kViewToggles = std::to_array<ViewToggle>({
    {"tracks", "Tracks", 0, &ViewToggles::tracks, "Inliers as circles, outliers as crosses"},
    {"tails", "Tails", 'T', &ViewToggles::tails, "Where each track came from in the last frames"},
    {"residuals", "Residual vectors", 'E', &ViewToggles::residuals,
     "From where a track is seen to where the result puts it, enlarged"},
    {"cube", "Cube", 'B', &ViewToggles::cube, "A cube that stands on the estimated plane"},
    {"wireframe", "Wireframe cube", 0, &ViewToggles::wireframe,
     "The cube's edges alone, without faces and shadow", kCubeMenu},
    {"tower", "Tower", 0, &ViewToggles::tower,
     "A tower of five cubes: its lean shows what a cube hides", kCubeMenu},
    {"truth", "Ground truth", 'G', &ViewToggles::truth,
     "True cameras, plane and cube in gray, where they are known"},
    {"gravity", "Gravity", 0, &ViewToggles::gravity,
     "Which way is up in the scene, and the horizon in the picture, by the accelerometer"},
    {"undistorted", "Without distortion", 'K', &ViewToggles::undistorted,
     "The picture as a pinhole camera with the same K would see it"},
    {"legend", "Legends", 0, &ViewToggles::legend,
     "What the signs and colors of picture and scene mean"},
    {"scan", "Scan for a start", 0, &ViewToggles::scan,
     "Initializes from everywhere in the recording, in the background, and shows above the time "
     "line where it succeeds; a click starts there"}});
// clang-format on

/// A number of `ViewToggles`: actions, keys, menus and sessions read the table.
struct ViewNumber {
  const char* key;     ///< in sessions
  const char* action;  ///< in scripts
  const char* title;   ///< for people
  char letter;         ///< of the keyboard; 0: none
  int ViewToggles::*value;
  const char* tooltip;       ///< one sentence
  const char* submenu;       ///< of the menu View; empty: the menu itself
  const char* arguments;     ///< of the action, as in `Action`
  std::array<int, 4> steps;  ///< without an argument the action takes the next one
  int least, most;           ///< in sessions; where there are no steps, also in scripts
  std::string (*text)(int);  ///< its value, for people
  int off;                   ///< the menu's check mark is set for larger values

  bool has_steps() const { return steps[0] != steps[1]; }
};

// clang-format off
inline constexpr auto kViewNumbers = std::to_array<ViewNumber>({
    {"uncertainty", "uncertainty", "Uncertainty", 'U', &ViewToggles::uncertainty,
     "95 % of camera centers and normal in the scene; again: enlarged 10 and 100 times, then off",
     "", "", {0, 1, 10, 100}, 0, 100,
     [](int times) { return times > 1 ? "\u00d7" + std::to_string(times) : times == 1 ? "on" : "off"; }, 0},
    {"exaggeration", "exaggerate", "Exaggerate the cube's error", 'D', &ViewToggles::exaggeration,
     "The cube's distance in the picture from the true one, or where there is none from the first "
     "column's, 5, 20 and 100 times as large as it is",
     kCubeMenu, "[1|5|20|100]", {1, 5, 20, 100}, 1, 100,
     [](int times) { return times > 1 ? std::to_string(times) + "\u00d7" : "off"; }, 1},
    {"point_size_px", "point-size", "Size of points", 0, &ViewToggles::point_size_px,
     "Of the scene's points [px]", "Colors and sizes", "1..20", {}, 1, 20,
     [](int size) { return std::to_string(size) + " px"; }, 20}});
// clang-format on

}  // namespace gpo
