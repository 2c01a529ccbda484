// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <array>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// What of a frame's picture is nearer to the camera than the cube.
struct Occluder {
  int plane = 0;  ///< that it shows, as the window counts them
  std::vector<std::array<Eigen::Vector2d, 3>> triangles_raw_px;
};

/// Where the window's other planes hide the cube of these corners in a frame of the window. A plane
/// is known to be seen between tracks of its own (their Delaunay triangles in the picture) that are
/// near each other and have no other plane's track or outlier between them. It hides the cube where
/// all of the cube that is seen through there lies behind it. What no plane tells hides nothing.
std::vector<Occluder> occluders(const Inspection& inspection,
                                int frame_in_window,
                                const std::array<Eigen::Vector3d, 8>& cube_corners_w);

}  // namespace gpo
