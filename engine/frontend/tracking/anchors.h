// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/tracking/local_shape.h"
#include "engine/frontend/tracking/patch.h"
#include "engine/geometry/camera.h"
#include "engine/window/tracks.h"

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

struct AnchorOptions {
  int half_patch_px = 10;    ///< half the side of a template, in the reference image [px]
  int least_alike = 5;       ///< least number of neighbors that move as a track does [-]
  double most_unlike = 0.5;  ///< largest difference of motions that are alike, as a share of the
                             ///< neighbors' motion; at least `search.farthest_px` [-]
  SearchOptions search = {};
};

/// Templates of tracks in the reference frame and their last warps, one a track.
struct Anchors {
  Camera camera;
  std::vector<PatchTemplate> patches;  ///< templates around the nearest whole pixels
  Eigen::Matrix2Xd corners_px;         ///< 2 x tracks, from the templates' middles
  std::vector<Neighborhood> neighborhoods;
  std::vector<Warp> warps;
};

/// Makes the templates. `image` is the smoothed reference image (smoothed_image.h); `raw_px`, 2 x
/// tracks, its corners in raw pixels.
Anchors make_anchors(const cv::Mat& image,
                     const Eigen::Matrix2Xd& raw_px,
                     const Camera& camera,
                     const AnchorOptions& options = {});

struct AlignedTracks {
  Eigen::Matrix2Xd raw_px;                    ///< 2 x tracks, NaN: lost
  std::vector<std::optional<TrackEnd>> ends;  ///< for tracks that are lost here; frame 0
};

/// Aligns the templates with the next smoothed image, so that tracks do not drift. `before_px` has
/// the tracks in the image before, NaN: lost, and `flow_px` their rough motion since; both 2 x
/// tracks, raw pixels. A track is lost if the alignment fails, if hardly any neighbor moves as it
/// does, or if its template is an edge along which it slides.
AlignedTracks align_tracks(Anchors& anchors,
                           const cv::Mat& image,
                           const Eigen::Matrix2Xd& before_px,
                           const Eigen::Matrix2Xd& flow_px,
                           const AnchorOptions& options = {});

}  // namespace gpo
