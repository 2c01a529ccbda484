// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/window.h"

#include <optional>
#include <stop_token>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Maps the visible normals to a unit disc with the image axes x right, y down: the center is the
/// plane that faces the camera, (0, 0, -1), on the rim planes are seen edge-on. The distance from
/// the center is the tilt in right angles (azimuthal equidistant).
Eigen::Vector2d disc_from_normal(const Eigen::Vector3d& normal);
/// Returns the unit normal of a point of the disc; beyond the rim it faces away.
Eigen::Vector3d normal_from_disc(const Eigen::Vector2d& disc);

/// Cost of each normal, with the window's rotations and the best translation of each frame for that
/// normal. A grid over the disc's square, row by row.
struct NormalLandscape {
  int side = 0;  ///< cells of a row and rows
  /// Half the summed squares of the inliers' transfer errors, side * side cells per frame [px^2];
  /// zero in the reference frame. NaN outside of the disc and if the plane's horizon runs through
  /// the inliers' rays; infinite if the translation puts points behind the camera.
  std::vector<std::vector<float>> cost_px2;
  std::vector<int> observations;  ///< number of inliers, one per frame
};

/// Returns the center of a cell on the disc.
Eigen::Vector2d disc_of_cell(int side, int row, int column);

/// Computes translations by linear least squares, weighted to pixels by the frames' homographies,
/// and subtracts the gain of one Gauss-Newton step from the true cost. nullopt if stopped.
std::optional<NormalLandscape> normal_landscape(const Window& window,
                                                int side,
                                                const std::stop_token& stop = {});

/// Returns the root mean square transfer error of each cell over the first `frames` frames,
/// including the reference frame [px].
std::vector<float> rms_px(const NormalLandscape& landscape, int frames);

}  // namespace gpo
