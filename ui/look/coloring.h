// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace gpo {

/// What the colors of tracks and map points tell.
enum class Coloring { plane, residual, depth, life };

/// The actions and sessions read the table.
struct ColoringRow {
  Coloring coloring;
  const char* key;    ///< in scripts and sessions
  const char* title;  ///< for people
  const char* tooltip;
};

inline constexpr std::array kColorings = {
    ColoringRow{Coloring::plane,
                "plane",
                "Color by plane",
                "Tracks and points in the color of their plane; outliers are red crosses"},
    ColoringRow{
        Coloring::residual,
        "residual",
        "Color by residual",
        "Inliers of the leading plane by their RMS reprojection error over the window [px]"},
    ColoringRow{Coloring::depth,
                "depth",
                "Color by depth",
                "Tracks and points by their depth in the reference camera [plane distances]"},
    ColoringRow{Coloring::life,
                "life",
                "Color by life",
                "Tracks and points by the number of frames that see them"}};

}  // namespace gpo
