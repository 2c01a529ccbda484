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

/// The board in one image.
struct CalibrationView {
  int frame = 0;
  std::vector<Eigen::Vector2d> corners;  ///< [raw px], as `find_board` returns them
  double edge_px = 0;                    ///< width of the edges between squares, at least 1
};

/// All views that a search found, in the order of time.
struct BoardSearch {
  cv::Size size;     ///< image size [px]
  int examined = 0;  ///< images
  std::vector<CalibrationView> views;
};

/// Searches at most `most_frames` images, evenly spread, on all processors. Leaves out views with
/// fewer than 8 corners. Throws InputError if an image cannot be decoded or differs in size.
BoardSearch find_calibration_views(const FrameCache& images,
                                   const Board& board,
                                   int most_frames,
                                   const std::function<void(int done, int of)>& progress = {},
                                   const std::stop_token& stop = {});

/// Chooses at most `count` views that differ most in place, size and slant, the sharper ones of
/// similar views, in the order of time. Leaves out views with edges of twice the median width.
std::vector<CalibrationView> choose_views(const BoardSearch& search, const Board& board, int count);

}  // namespace gpo
