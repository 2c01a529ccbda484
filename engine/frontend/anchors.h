// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/homography_ransac.h"
#include "engine/geometry/camera.h"
#include "engine/window/tracks.h"
#include "engine/window/window.h"

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

struct AnchorOptions {
  int half_patch_px = 10;          ///< half the side of a look, in the reference picture [px]
  double blur_px = 0.55;           ///< standard deviation, of both pictures before comparing [px]
  double farthest_px = 5;          ///< a look is not searched farther from its prediction [px]
  double least_correlation = 0.7;  ///< zero-mean normalized, below it a track is lost [-]
  RansacOptions ransac = {};       ///< tells the tracks on the plane; with a seed of its own
};

/// A look's pixels where they are carried to, exact at 3 x 3 nodes: left, middle and right of its
/// first, middle and last row. 2 x 9, row by row.
using Nodes = Eigen::Matrix<double, 2, 9>;

/// The places of all pixels, row by row, on the quadratics through those of the nodes; 2 x pixels.
Eigen::Matrix2Xf places_between(const Nodes& nodes_px, int width, int height);

/// What a track looks like in the reference frame: the whole pixels around its corner.
struct Look {
  int width = 0;         ///< [px]
  int height = 0;        ///< [px]
  Nodes undistorted_px;  ///< where its nodes are
  /// One pixel a row: slopes of the brightness along x and y [gray levels / px], brightness with
  /// the mean taken off [gray levels], 1.
  Eigen::Matrix<float, Eigen::Dynamic, 4> model;
  Eigen::Matrix4f normal;  ///< model^T model
};

/// The looks of a window's tracks in its reference frame, to which `hold` compares later frames.
struct Anchors {
  Camera camera;
  Eigen::Matrix2Xd undistorted_px;  ///< 2 x tracks, the corners
  std::vector<Look> looks;          ///< one a track
};

/// `gray` is the reference picture, CV_8UC1; `raw_px` 2 x tracks, its corners in raw pixels.
Anchors make_anchors(const cv::Mat& gray,
                     const Eigen::Matrix2Xd& raw_px,
                     const Camera& camera,
                     const AnchorOptions& options = {});

struct Held {
  Eigen::Matrix2Xd raw_px;                    ///< 2 x tracks, NaN: lost
  std::vector<std::optional<TrackEnd>> ends;  ///< of those whose look is not found; frame 0
};

/// Takes the drift from tracks on the plane. `followed_px` is 2 x tracks, raw pixels of the picture
/// `gray` to which frame-to-frame tracking came, NaN: lost. A track that agrees with the homography
/// from the reference frame is searched for with its own look, carried over by that homography and
/// the lens, whatever gain and offset the exposure has; it is lost where its look is not found. The
/// others stay as they are.
Held hold(const Anchors& anchors,
          const cv::Mat& gray,
          const Eigen::Matrix2Xd& followed_px,
          const AnchorOptions& options = {});

}  // namespace gpo
