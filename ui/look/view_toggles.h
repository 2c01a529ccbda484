// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Actions, keys, menus and sessions read the tables below.
#pragma once

#include "ui/look/palette.h"

#include <array>
#include <string>

namespace gpo {

/// Quantity that the colors of tracks and map points show.
enum class Coloring { plane, residual, depth, life };

/// Direction from which the scene is seen until the user drags it.
enum class Viewpoint { oblique, top, front, side, camera };

template <class E>
struct ChoiceRow {
  E value;
  const char* key;    ///< in scripts and sessions
  const char* title;  ///< for people
  const char* tooltip;
  char keypad = 0;  ///< digit of the keypad, as in Blender; 0: none
};

// clang-format off
inline constexpr auto kColorings = std::to_array<ChoiceRow<Coloring>>({
    {Coloring::plane, "plane", "Color by plane",
     "Colors tracks and points by their plane; outliers are red crosses"},
    {Coloring::residual, "residual", "Color by residual",
     "Colors inliers of the leading plane by their RMS reprojection error over the window [px]"},
    {Coloring::depth, "depth", "Color by depth",
     "Colors tracks and points by their depth in the reference camera [plane distances]"},
    {Coloring::life, "life", "Color by life",
     "Colors tracks and points by the number of frames that see them"}});

inline constexpr auto kViewpoints = std::to_array<ChoiceRow<Viewpoint>>({
    {Viewpoint::oblique, "oblique", "From above and behind",
     "Shows the scene from behind the reference camera, above and beside it", '5'},
    {Viewpoint::top, "top", "From the top", "Shows the scene from straight above", '7'},
    {Viewpoint::front, "front", "Along the camera",
     "Looks along the plane in the direction of the reference camera: shows roll and height", '1'},
    {Viewpoint::side, "side", "From the side",
     "Looks along the plane, across the reference camera: shows pitch and height", '3'},
    {Viewpoint::camera, "camera", "Through the camera",
     "Shows the scene as the current frame's estimated camera sees it; follows the frame", '0'}});

inline constexpr const char* kThemeTooltip = "Sets the window's colors; methods and data keep theirs";
inline constexpr auto kThemes = std::to_array<ChoiceRow<Theme>>({
    {Theme::dark, "dark", "Dark theme", kThemeTooltip},
    {Theme::light, "light", "Light theme", kThemeTooltip}});
// clang-format on

constexpr const auto& choice_rows(Coloring /*any*/) { return kColorings; }
constexpr const auto& choice_rows(Viewpoint /*any*/) { return kViewpoints; }
constexpr const auto& choice_rows(Theme /*any*/) { return kThemes; }

/// Content of the views. The views read the members, all other code reads the rows below.
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
  int point_size_px = 5;  ///< in the scene, at scale 1

  bool operator==(const ViewToggles&) const = default;
};

struct ViewToggle {
  const char* key;    ///< in scripts and sessions
  const char* title;  ///< for people
  char letter;        ///< on the keyboard; 0: none
  bool ViewToggles::*shown;
  const char* tooltip;       ///< one sentence
  const char* submenu = "";  ///< in the menu View; empty: the menu itself
};

inline constexpr const char* kCubeMenu = "Cube style";

// clang-format off
inline constexpr auto kViewToggles = std::to_array<ViewToggle>({
    {"tracks", "Tracks", 0, &ViewToggles::tracks, "Shows inliers as circles, outliers as crosses"},
    {"tails", "Tails", 'T', &ViewToggles::tails, "Shows each track's path over the last frames"},
    {"residuals", "Residual vectors", 'E', &ViewToggles::residuals,
     "Shows residuals from observed to predicted position, enlarged"},
    {"cube", "Cube", 'B', &ViewToggles::cube, "Shows a cube on the estimated plane"},
    {"wireframe", "Wireframe cube", 0, &ViewToggles::wireframe,
     "Shows only the cube's edges, without faces and shadow", kCubeMenu},
    {"tower", "Tower", 0, &ViewToggles::tower,
     "Shows a tower of five cubes: small tilts are easier to see", kCubeMenu},
    {"truth", "Ground truth", 'G', &ViewToggles::truth,
     "Shows the true cameras, plane and cube in gray, if known"},
    {"gravity", "Gravity", 0, &ViewToggles::gravity,
     "Shows the up direction in the scene and the horizon in the image, from the accelerometer"},
    {"undistorted", "Undistort", 'K', &ViewToggles::undistorted,
     "Shows the image as a pinhole camera with the same K sees it"},
    {"legend", "Legends", 0, &ViewToggles::legend,
     "Explains the signs and colors of image and scene"},
    {"scan", "Scan for a start", 0, &ViewToggles::scan,
     "Initializes from frames all over the recording, in the background, and shows above the time "
     "line where it succeeds; click to start there"}});
// clang-format on

struct ViewNumber {
  const char* key;     ///< in sessions
  const char* action;  ///< in scripts
  const char* title;   ///< for people
  char letter;         ///< on the keyboard; 0: none
  int ViewToggles::*value;
  const char* tooltip;       ///< one sentence
  const char* submenu;       ///< in the menu View; empty: the menu itself
  const char* arguments;     ///< same as `Action::arguments`
  std::array<int, 4> steps;  ///< the action without an argument goes to the next one
  int least, most;           ///< in sessions, and in scripts if there are no steps
  std::string (*text)(int);  ///< formats the value for people
  int off;                   ///< the menu's check mark is set for larger values

  bool has_steps() const { return steps[0] != steps[1]; }
};

// clang-format off
inline constexpr auto kViewNumbers = std::to_array<ViewNumber>({
    {"uncertainty", "uncertainty", "Uncertainty", 'U', &ViewToggles::uncertainty,
     "Shows the 95 % regions of camera centers and normal in the scene. Press again for 10x, 100x, off",
     "", "", {0, 1, 10, 100}, 0, 100,
     [](int times) { return times > 1 ? "\u00d7" + std::to_string(times) : times == 1 ? "on" : "off"; }, 0},
    {"exaggeration", "exaggerate", "Exaggerate the cube's error", 'D', &ViewToggles::exaggeration,
     "Enlarges the cube's image error, from the true cube or else the first column's. Press again for "
     "5x, 20x, 100x, off",
     kCubeMenu, "[1|5|20|100]", {1, 5, 20, 100}, 1, 100,
     [](int times) { return times > 1 ? std::to_string(times) + "\u00d7" : "off"; }, 1},
    {"point_size_px", "point-size", "Size of points", 0, &ViewToggles::point_size_px,
     "Sets the size of the scene's points [px]", "Colors and sizes", "1..20", {}, 1, 20,
     [](int size) { return std::to_string(size) + " px"; }, 20}});
// clang-format on

}  // namespace gpo
