// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/window.h"

#include <functional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

// To first order, a rolling shutter moves a point by its own velocity. Selection of inliers and
// rotations from images use points that are moved back; estimates of poses use the points as they
// are (engine/method.md, "Rolling shutter in the front end").

/// Moves the window's points, or its tracks in the image as recorded, to where they were at the
/// time stamps of their frames: p - s v dp/dt, v the row (`Window::rows`). One per frame, 2 x
/// tracks, NaN: not seen.
std::vector<Eigen::Matrix2Xd> without_readout(const Window& window,
                                              std::vector<Eigen::Matrix2Xd> points_px,
                                              double row_delay_s);

/// Returns the window with its points moved back by the row delay that was compensated when its
/// inliers were selected, and with homographies fitted to them.
Window at_time_stamps(Window window);

/// Returns plausible row delays within three standard deviations of the estimate; none if that is
/// within two of zero.
std::vector<double> likely_row_delays_s(const Window& window);

/// Returns the window with inliers selected by `select` for its known row delay, or else for one
/// that shows in its tracks or without which it has no plane. Keeps the window if there is none.
/// `select` makes a window of the same tracks without the effect of a row delay [s/row].
Window with_late_rows(const Window& window, const std::function<Window(double)>& select);

}  // namespace gpo
