// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

namespace gpo {

/// The field (the even rows are the top one) that an interlaced frame's time stamp is that of; the
/// other one follows half a frame later.
enum class FieldOrder { top_first, bottom_first };

/// For each point that moves by more than a pixel to the next frame, the part of this motion that
/// is between the even and the odd rows of the frame: about 0 in a progressive video, 0.5 or -0.5
/// if the top or the bottom field is first. Expects images as stored, 8 bits.
std::vector<double> field_motions(const cv::Mat& frame, const cv::Mat& next);

/// Returns nullopt for a progressive video, or without motion.
std::optional<FieldOrder> field_order(const std::vector<double>& motions);

/// Returns an image of the same size from the rows of the first field, CV_8UC3. These stay where
/// they are, so that the camera's principal point does; the rows between are interpolated.
cv::Mat first_field(const cv::Mat& frame, FieldOrder order);

}  // namespace gpo
