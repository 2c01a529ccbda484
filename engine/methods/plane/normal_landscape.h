// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/window.h"

#include <optional>
#include <stop_token>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// The normals that a camera can see on a unit disc, as in the picture: x right, y down; in the
/// middle the plane that faces the camera, (0, 0, -1), on the rim those seen edge-on. The distance
/// from the middle is the tilt, in right angles (azimuthal equidistant).
Eigen::Vector2d disc_from_normal(const Eigen::Vector3d& normal);
/// Of unit length. Beyond the rim: normals that face away.
Eigen::Vector3d normal_from_disc(const Eigen::Vector2d& disc);

/// What a plane of each normal costs, each frame's rotation as the window has it and its
/// translation the best one for that normal. A grid over the disc's square, row by row.
struct NormalLandscape {
  int side = 0;  ///< cells of a row and rows
  /// One a frame, side * side cells: half the summed squares of its inliers' transfer errors
  /// [px^2]; zero in the reference frame. NaN outside of the disc and where the plane's horizon
  /// runs through the inliers' rays; infinite where the translation puts points behind the camera.
  std::vector<std::vector<float>> cost_px2;
  std::vector<int> observations;  ///< one a frame: its inliers
};

/// Where a cell's middle is on the disc.
Eigen::Vector2d disc_of_cell(int side, int row, int column);

/// The translations are by linear least squares, weighted to pixels by the frames' homographies;
/// what a Gauss-Newton step from there gains is taken off the true cost. Nothing where stopped.
std::optional<NormalLandscape> normal_landscape(const Window& window,
                                                int side,
                                                const std::stop_token& stop = {});

/// Root mean square transfer error [px] of an observation over the first so many frames, the
/// reference frame among them; one a cell.
std::vector<float> rms_px(const NormalLandscape& landscape, int frames);

}  // namespace gpo
