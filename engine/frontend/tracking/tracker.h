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

struct DetectorOptions {
  int grid_columns = 10;     ///< cells over which corners are spread [-]
  int grid_rows = 8;         ///< [-]
  int most_per_cell = 3;     ///< strongest corners kept in a cell [-]
  int threshold = 20;        ///< FAST threshold [gray levels]
  int weak_threshold = 7;    ///< the same where a cell has no corner at `threshold` [gray levels]
  int border_px = 12;        ///< no corner nearer to the picture's edge [px]
  double spacing = 0.014;    ///< least distance between corners [picture widths]
  int subpixel_half_px = 5;  ///< half the side of the window of the sub-pixel search [px]
};

/// FAST corners, the strongest of each cell of a grid, sub-pixel refined. `gray` is CV_8UC1; 2 x n
/// raw pixels, ordered by cell and strength.
Eigen::Matrix2Xd detect_corners(const cv::Mat& gray, const DetectorOptions& options = {});

struct TrackerOptions {
  DetectorOptions detector = {};
  int window_px = 21;                ///< side of the patch that is compared [px]
  int pyramid_levels = 4;            ///< beside the full picture [-]
  double forward_backward_px = 0.5;  ///< largest distance after tracking there and back [px]
  Tracking tracking = Tracking::frame_to_frame;
  AnchorOptions anchor = {};  ///< of anchored tracking
};

/// A frame of the recording in gray, CV_8UC1. Throws InputError where it cannot be decoded.
using GrayImages = std::function<cv::Mat(int frame)>;

/// Told of what is done; "tracking 41/60".
using FrameProgress = std::function<void(int done, int of)>;

/// Corners of the reference frame followed from frame to frame: by pyramidal KLT, forward and back,
/// or, in anchored tracking, by their looks in the reference frame. A track is lost for good in the
/// first frame in which it fails a check or leaves the picture. Nothing where stopped. Throws
/// InputError for a picture that cannot be decoded.
std::optional<Tracks> track_window(const GrayImages& images,
                                   const Camera& camera,
                                   int start,
                                   int frames,
                                   const TrackerOptions& options = {},
                                   const std::stop_token& stop = {},
                                   const FrameProgress& progress = {});

}  // namespace gpo
