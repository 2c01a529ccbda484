// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/tracking/local_shape.h"
#include "engine/frontend/tracking/patch_alignment.h"
#include "engine/geometry/camera.h"
#include "engine/window/tracks.h"

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

struct AnchorOptions {
  int half_patch_px = 10;    ///< half the side of a look, in the reference picture [px]
  int least_alike = 5;       ///< so many neighbors at least move as a track does [-]
  double most_unlike = 0.5;  ///< from their motion its own differs by no more than this share of
                             ///< it, or than `search.farthest_px` [-]
  SearchOptions search = {};
  ShapeOptions shape = {};
};

/// What tracks look like in the reference frame, and where and how each was seen last.
struct Anchors {
  Camera camera;
  std::vector<PatchTemplate> patches;                ///< one a track, around its nearest whole pixel
  Eigen::Matrix2Xd corners_px;              ///< 2 x tracks, from the looks' middles
  std::vector<Neighborhood> neighborhoods;  ///< one a track
  std::vector<Warp> warps;                  ///< one a track, of its look
};

/// `soft` is the reference picture (smoothed_image.h); `raw_px` 2 x tracks, its corners in raw
/// pixels.
Anchors make_anchors(const cv::Mat& smoothed,
                     const Eigen::Matrix2Xd& raw_px,
                     const Camera& camera,
                     const AnchorOptions& options = {});

struct Held {
  Eigen::Matrix2Xd raw_px;                    ///< 2 x tracks, NaN: lost
  std::vector<std::optional<TrackEnd>> ends;  ///< of those that are lost here; frame 0
};

/// Finds the tracks' looks in the next soft picture, so that they do not drift. `before_px` is
/// where the tracks were in the one before, NaN: lost, and `flow_px` by how much they have moved,
/// roughly; both 2 x tracks, raw pixels. A track is lost where its look is not found, where it
/// moves as hardly any of its neighbors, and where the look is an edge along which it slides.
Held hold(Anchors& anchors,
          const cv::Mat& smoothed,
          const Eigen::Matrix2Xd& before_px,
          const Eigen::Matrix2Xd& flow_px,
          const AnchorOptions& options = {});

}  // namespace gpo
