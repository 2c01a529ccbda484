// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace gpo {

/// What is drawn into picture, scene and time line.
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
  int uncertainty = 1;    ///< of the scene, enlarged so many times: 0 (not shown), 1, 10, 100
  int exaggeration = 1;   ///< of the cube's distance from the true one, or the first column's
  int point_size_px = 5;  ///< of the scene, at scale 1

  bool operator==(const ViewToggles&) const = default;
};

/// A switch of `ViewToggles`: the actions and sessions read the table.
struct ViewToggle {
  const char* key;    ///< in scripts and sessions
  const char* title;  ///< for people
  char letter;        ///< of the keyboard; 0: none
  bool ViewToggles::*shown;
  const char* tooltip;  ///< one sentence
};

inline constexpr std::array kViewToggles = {
    ViewToggle{
        "tracks", "Tracks", 0, &ViewToggles::tracks, "Inliers as circles, outliers as crosses"},
    ViewToggle{"tails",
               "Tails",
               'T',
               &ViewToggles::tails,
               "Where each track came from in the last frames"},
    ViewToggle{"residuals",
               "Residual vectors",
               'E',
               &ViewToggles::residuals,
               "From where a track is seen to where the result puts it, enlarged"},
    ViewToggle{
        "cube", "Cube", 'B', &ViewToggles::cube, "A cube that stands on the estimated plane"},
    ViewToggle{"wireframe",
               "Wireframe cube",
               0,
               &ViewToggles::wireframe,
               "The cube's edges alone, without faces and shadow"},
    ViewToggle{"tower",
               "Tower",
               0,
               &ViewToggles::tower,
               "A tower of five cubes: its lean shows what a cube hides"},
    ViewToggle{"truth",
               "Ground truth",
               'G',
               &ViewToggles::truth,
               "True cameras, plane and cube in gray, where they are known"},
    ViewToggle{
        "gravity",
        "Gravity",
        0,
        &ViewToggles::gravity,
        "Which way is up in the scene, and the horizon in the picture, by the accelerometer"},
    ViewToggle{"undistorted",
               "Without distortion",
               'K',
               &ViewToggles::undistorted,
               "The picture as a pinhole camera with the same K would see it"},
    ViewToggle{"legend",
               "Legends",
               0,
               &ViewToggles::legend,
               "What the signs and colors of picture and scene mean"},
    ViewToggle{"scan",
               "Scan for a start",
               0,
               &ViewToggles::scan,
               "Initializes from everywhere in the recording, in the background, and shows above "
               "the time line where it succeeds; a click starts there"}};

}  // namespace gpo
