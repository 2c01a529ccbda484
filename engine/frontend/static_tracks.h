// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/tracks.h"

#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Returns the tracks that do not move in the image although the homographies of the moving tracks
/// predict it, ascending: an overlay, a part of the camera's carrier, dirt on the lens, or a camera
/// at rest before a moving object. A track near the focus of expansion is not among them. Empty if
/// all tracks rest. `points_px` is one per frame, 2 x tracks, undistorted, NaN: not seen;
/// `sigma_px` as `Tracks::sigma_px`; `unit_px` is the `pixel_unit`.
std::vector<int> static_tracks(const std::vector<Eigen::Matrix2Xd>& points_px,
                               const std::vector<Eigen::VectorXd>& sigma_px,
                               double unit_px);

}  // namespace gpo
