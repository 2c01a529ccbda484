// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace gpo {

/// From where the scene is looked at until somebody drags it.
enum class Viewpoint { oblique, top, front, side, camera };

/// The actions and sessions read the table.
struct ViewpointRow {
  Viewpoint viewpoint;
  const char* key;    ///< in scripts and sessions
  const char* title;  ///< for people
  char keypad;        ///< the digit of the keypad, as in Blender; 0: none
  const char* tooltip;
};

inline constexpr std::array kViewpoints = {
    ViewpointRow{Viewpoint::oblique,
                 "oblique",
                 "From above and behind",
                 '5',
                 "The scene from behind the reference camera, above and beside it"},
    ViewpointRow{Viewpoint::top, "top", "From the top", '7', "The scene from straight above"},
    ViewpointRow{Viewpoint::front,
                 "front",
                 "Along the camera",
                 '1',
                 "The scene along the plane, as the reference camera looks: shows roll and height"},
    ViewpointRow{Viewpoint::side,
                 "side",
                 "From the side",
                 '3',
                 "The scene along the plane, across the reference camera: shows pitch and height"},
    ViewpointRow{Viewpoint::camera,
                 "camera",
                 "Through the camera",
                 '0',
                 "The scene as the current frame's estimated camera sees it; follows the frame"}};

}  // namespace gpo
