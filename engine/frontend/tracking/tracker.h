// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/tracking/anchors.h"
#include "engine/frontend/tracking/tracking.h"
#include "engine/geometry/camera.h"
#include "engine/window/tracks.h"

#include <functional>
#include <optional>
#include <span>
#include <stop_token>

#include <opencv2/core.hpp>

namespace gpo {

/// Detects FAST corners, the strongest of each cell of a grid, and refines them to sub-pixels.
/// `gray` is CV_8UC1. Returns 2 x n raw pixels, ordered by cell and strength.
Eigen::Matrix2Xd detect_corners(const cv::Mat& gray);

/// Returns a frame of the recording in gray, CV_8UC1. Throws InputError if it cannot be decoded.
using GrayImages = std::function<cv::Mat(int frame)>;

/// Called after each frame; "tracking 41/60".
using FrameProgress = std::function<void(int done, int of)>;

/// How a tracking run is stopped and reports.
struct TrackingRun {
  std::stop_token stop = {};
  FrameProgress progress = {};
};

/// Detects corners in the reference frame and tracks them from frame to frame: by pyramidal KLT,
/// forward and back, or, in anchored tracking, by their templates in the reference frame. A track
/// ends in the first frame in which it fails a check or leaves the image. Returns nullopt if
/// stopped. Throws InputError for an image that cannot be decoded.
std::optional<Tracks> track_window(const GrayImages& images,
                                   const Camera& camera,
                                   const FrameSpan& span,
                                   Tracking tracking = Tracking::frame_to_frame,
                                   const TrackingRun& run = {});

}  // namespace gpo
