// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <functional>
#include <stop_token>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// The board as one picture shows it.
struct CalibrationView {
  int frame = 0;
  std::vector<Eigen::Vector2d> corners;  ///< [raw px], as `find_board` gives them
  double edge_px = 0;  ///< how wide the edges between squares are, at least 1; more where blurred
};

/// All that a search found, in the order of time.
struct BoardSearch {
  cv::Size size;     ///< of the pictures [px]
  int examined = 0;  ///< pictures
  std::vector<CalibrationView> views;
};

/// Looks for the board in a regular sample of at most `most_frames` pictures, on all processors.
/// Views with fewer than 8 corners are left out. Throws InputError where a picture cannot be
/// decoded, or has another size than the first.
BoardSearch find_calibration_views(const FrameCache& images,
                                   const Board& board,
                                   int most_frames,
                                   const std::function<void(int done, int of)>& progress = {},
                                   const std::stop_token& stop = {});

/// At most `count` views that differ most in place, size and slant, the sharper of similar ones; in
/// the order of time. Views whose edges are more than twice as wide as the median are left out.
std::vector<CalibrationView> choose_views(const BoardSearch& search, const Board& board, int count);

}  // namespace gpo
