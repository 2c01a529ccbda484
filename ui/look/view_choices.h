// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/palette.h"

#include <array>

namespace gpo {

/// What the colors of tracks and map points show.
enum class Coloring { plane, residual, depth, life };

/// From where the scene is seen until the user drags it.
enum class Viewpoint { oblique, top, front, side, camera };

/// One value of a choice of how views look: actions and sessions read the tables.
template <class E>
struct ChoiceRow {
  E value;
  const char* key;    ///< in scripts and sessions
  const char* title;  ///< for people
  const char* tooltip;
  char keypad = 0;  ///< the digit of the keypad, as in Blender; 0: none
};

// clang-format off
inline constexpr auto kColorings = std::to_array<ChoiceRow<Coloring>>({
    {Coloring::plane, "plane", "Color by plane",
     "Tracks and points in the color of their plane; outliers are red crosses"},
    {Coloring::residual, "residual", "Color by residual",
     "Inliers of the leading plane by their RMS reprojection error over the window [px]"},
    {Coloring::depth, "depth", "Color by depth",
     "Tracks and points by their depth in the reference camera [plane distances]"},
    {Coloring::life, "life", "Color by life",
     "Tracks and points by the number of frames that see them"}});

inline constexpr auto kViewpoints = std::to_array<ChoiceRow<Viewpoint>>({
    {Viewpoint::oblique, "oblique", "From above and behind",
     "The scene from behind the reference camera, above and beside it", '5'},
    {Viewpoint::top, "top", "From the top", "The scene from straight above", '7'},
    {Viewpoint::front, "front", "Along the camera",
     "The scene along the plane, as the reference camera looks: shows roll and height", '1'},
    {Viewpoint::side, "side", "From the side",
     "The scene along the plane, across the reference camera: shows pitch and height", '3'},
    {Viewpoint::camera, "camera", "Through the camera",
     "The scene as the current frame's estimated camera sees it; follows the frame", '0'}});

inline constexpr const char* kThemeTooltip = "Colors of the window; those of methods and data stay";
inline constexpr auto kThemes = std::to_array<ChoiceRow<Theme>>({
    {Theme::dark, "dark", "Dark theme", kThemeTooltip},
    {Theme::light, "light", "Light theme", kThemeTooltip}});
// clang-format on

constexpr const auto& choice_rows(Coloring /*any*/) { return kColorings; }
constexpr const auto& choice_rows(Viewpoint /*any*/) { return kViewpoints; }
constexpr const auto& choice_rows(Theme /*any*/) { return kThemes; }

}  // namespace gpo
