// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/window.h"

#include <functional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

// A rolling shutter moves a point by its own velocity. Inliers and rotations use points that are
// moved back, poses the points as they are (engine/method.md, "Rolling shutter in the front end").

/// Moves the window's points, or its tracks, to the time stamps of their frames: p - s d^T (p - c)
/// dp/dt, d the readout direction. One a frame, 2 x tracks, NaN: not seen.
std::vector<Eigen::Matrix2Xd> without_readout(const Window& window,
                                              std::vector<Eigen::Matrix2Xd> points_px,
                                              double row_delay_s);

/// Returns the window with points moved back by the row delay of the selection of its inliers.
Window at_time_stamps(Window window);

/// Row delay [s/row] by the homographies' residuals; 0 unless it is plausible and significant.
double visible_row_delay_s(const Window& window);

/// Returns plausible row delays within three sigmas of the estimate; none within two of zero.
std::vector<double> likely_row_delays_s(const Window& window);

/// Selects inliers by `select` for the known row delay [s/row], or else for one that shows in the
/// tracks or without which there is no plane. Keeps the window if there is none.
Window with_late_rows(const Window& window, const std::function<Window(double)>& select);

}  // namespace gpo
