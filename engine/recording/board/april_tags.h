// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// How many different tags there are in the family 36h11.
int april_tag_count();

/// Corners of a board of tags [raw px], as `find_board` gives them: of the tags that are seen, the
/// others NaN. Empty where there is none. Tags are numbered as Kalibr prints them: from the bottom
/// row on, from left to right.
std::vector<Eigen::Vector2d> find_april_tags(const cv::Mat& gray, const Board& board);

}  // namespace gpo
