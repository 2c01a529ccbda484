// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/tracking/patch.h"
#include "engine/tracking/tracking.h"

#include <functional>
#include <limits>
#include <span>
#include <stop_token>

#include <opencv2/core.hpp>

namespace gpo {

inline constexpr int kHalfPatch_px = 10;  ///< half the side of a template of a track

/// A template's pixels at left, middle and right of its first, middle and last row; 2 x 9, by row.
using Nodes = Eigen::Matrix<double, 2, 9>;

/// Tracks around a track in the reference frame, whose motion determines how its template deforms.
/// All places are undistorted.
struct Neighborhood {
  std::vector<int> neighbors;  ///< the nearest first
  /// Each from the template's middle, in the reference frame, padded by zeros [100 px].
  std::vector<double> dx, dy;
  Nodes nodes_px;  ///< in the reference frame, from the template's middle
};

/// Returns the neighborhood of each track. `raw_px` is 2 x tracks, in the reference frame;
/// templates are around the nearest whole pixel.
std::vector<Neighborhood> make_neighborhoods(const Camera& camera, const Eigen::Matrix2Xd& raw_px);

/// Returns the nodes of a template around a whole raw pixel, undistorted [px].
Nodes patch_nodes(const Camera& camera, const Eigen::Vector2d& middle_px);

/// Returns the warp in raw pixels of a template with these nodes under a homography of undistorted
/// pixels. Returns nullopt if the lens cannot show a node, or the template would be mirrored.
std::optional<Warp> warp_by(const Camera& camera, const Eigen::Matrix3d& H, const Nodes& nodes_px);

/// Returns the warp with its center unchanged and the shape that a homography and the lens give the
/// template. The homography is fitted robustly to the warped corners of the template and to the
/// neighbors that agree with it (engine/method.md, 15b). `undistorted_px` has all tracks in the
/// same image, 2 x tracks, NaN: lost. Returns the warp unchanged if the lens cannot show it.
Warp shaped(const Camera& camera,
            const Warp& warp,
            const Eigen::Matrix2Xd& undistorted_px,
            const Neighborhood& neighborhood);

struct AnchorOptions {
  int least_alike = 5;       ///< least number of neighbors that move as a track does [-]
  double most_unlike = 0.5;  ///< largest difference of motions that are alike, as a share of the
                             ///< neighbors' motion; at least `search.farthest_px` [-]
  SearchOptions search = {};
};

/// Returns the `pixel_unit` of distances between tracks, at least 1: a template has as many pixels
/// in a small image.
double patch_unit(const Camera& camera);
/// Returns the options with distances in `patch_unit`.
AnchorOptions anchor_options(const Camera& camera);

/// Templates of tracks in the reference frame and their last warps, one per track.
struct Anchors {
  Camera camera;
  std::vector<PatchTemplate> patches;  ///< templates around the nearest whole pixels
  Eigen::Matrix2Xd corners_px;         ///< 2 x tracks, from the templates' middles
  std::vector<Neighborhood> neighborhoods;
  std::vector<Warp> warps;
  Eigen::VectorXd periods_px;  ///< one for each template; empty if the texture does not repeat
};

/// Makes the templates. `image` is the smoothed reference image; `raw_px`, 2 x
/// tracks, its corners in raw pixels.
Anchors make_anchors(const cv::Mat& image, const Eigen::Matrix2Xd& raw_px, const Camera& camera);

/// Tracks in the next image.
struct FollowedTracks {
  explicit FollowedTracks(Eigen::Index tracks) : ends(tracks) {
    raw_px.setConstant(2, tracks, std::numeric_limits<double>::quiet_NaN());
    forward_backward_px.setConstant(tracks, std::numeric_limits<double>::quiet_NaN());
  }

  Eigen::Matrix2Xd raw_px;                    ///< 2 x tracks, NaN: lost
  Eigen::VectorXd forward_backward_px;        ///< NaN: not measured
  std::vector<std::optional<TrackEnd>> ends;  ///< for tracks that are lost here; frame 0
};

/// Aligns the templates with the next smoothed image, so that tracks do not drift. `before_px` has
/// the tracks in the image before, NaN: lost, and `flow_px` their rough motion since; both 2 x
/// tracks, raw pixels. A track is lost if the alignment fails, if hardly any neighbor moves as it
/// does, or if its template is an edge along which it slides.
FollowedTracks align_tracks(Anchors& anchors,
                            const cv::Mat& image,
                            const Eigen::Matrix2Xd& before_px,
                            const Eigen::Matrix2Xd& flow_px,
                            const AnchorOptions& options = {});

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

/// Detects corners in the first image and tracks them from image to image, see `track_window`.
class WindowTracker {
 public:
  WindowTracker(const Camera& camera, Tracking tracking, int start = 0);

  /// Adds the next image, CV_8UC1.
  void add(const cv::Mat& gray);
  /// Forgets every second frame but the first and the last.
  void drop_every_second();
  const Tracks& tracks() const { return tracks_; }

 private:
  Camera camera_;
  Tracks tracks_;
  std::vector<cv::Mat> last_;  ///< pyramid of the last image
  Eigen::Matrix2Xd earlier_;   ///< tracks in the image before the last one
  Anchors anchors_;            ///< in anchored tracking
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
