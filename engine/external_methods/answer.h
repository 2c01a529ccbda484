// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"

#include <span>
#include <string_view>

namespace gpo {

/// The result of a user's own method for a window, in any world and scale.
struct Answer {
  std::optional<std::string> failed;         ///< the reason; all other members are then empty
  std::vector<std::optional<Pose>> cameras;  ///< one per frame; never nullopt for the first
  std::optional<Plane> plane;                ///< unit normal
  std::vector<PlaneEstimate> planes;         ///< each of the window's planes at most once
  std::vector<MapPoint> points;              ///< each track at most once
  std::optional<double> milliseconds;        ///< running time as reported by the method
};

/// The sizes that an answer must have.
struct ExpectedAnswer {
  int id = 0;  ///< id of the question; an answer may repeat it
  int frames = 0;
  int tracks = 0;
  int planes = 0;
};

/// Reads a line of `method_answer.schema.json`. Throws InputError that names the key:
/// "cameras[3].R_wc: expected 9 numbers".
Answer read_answer(std::string_view line, const ExpectedAnswer& expected);

/// Converts an answer into a result in the axes of the reference camera with the leading plane at
/// distance 1. Missing points are those on the plane or, without a plane, triangulated; a missing
/// plane is fitted to the inlier points; a missing camera is resected from the points. Fails with a
/// reason if that is impossible or if the result does not fit the window's tracks.
Initialization initialization_of(const Window& window, const Answer& answer);

/// Triangulates the inlier tracks that at least two of the given cameras (one entry per frame) see.
std::vector<MapPoint> triangulated(const Window& window,
                                   std::span<const std::optional<Pose>> given);

/// Returns the camera of a frame from the points that it sees; nullopt if these are too few.
std::optional<Pose> resected(const Window& window, const std::vector<MapPoint>& points, int frame);

}  // namespace gpo
