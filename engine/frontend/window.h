// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/choice.h"
#include "engine/frontend/homography_ransac.h"
#include "engine/frontend/tracking.h"
#include "engine/geometry/camera.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Why the built-in front end gave a track up.
enum class LossReason {
  left_picture,
  no_flow,           ///< KLT gives up, there or on the way back
  forward_backward,  ///< the way there and back ends too far from where it began [px]
  look_not_found,    ///< too little of its look in the reference frame is in the picture
  look_far,          ///< its look is found too far from where the plane's homography puts it [px]
  look_unlike        ///< what is found is not like its look: correlation too low [-]
};

/// How a track ended: what was measured and the limit that it broke, NaN where it is no number.
struct TrackEnd {
  int frame = 0;  ///< of the window, the first in which it is not seen
  LossReason reason = LossReason::no_flow;
  double value = std::numeric_limits<double>::quiet_NaN();
  double limit = std::numeric_limits<double>::quiet_NaN();
};

/// Tracks that start in the reference frame, as they were followed through the window: what the
/// picture shows. Column j of every matrix is track j; NaN where it is not seen.
struct Tracks {
  int start = 0;                         ///< reference frame, counts in the recording
  std::vector<std::int64_t> ids;         ///< one a track
  std::vector<Eigen::Matrix2Xd> raw_px;  ///< one a frame, 2 x tracks, raw pixels
  /// How far each track's way from the frame before and back ends from where it began, one a frame,
  /// of each track; NaN: not measured. Empty of other people's tracks.
  std::vector<Eigen::VectorXd> forward_backward_px = {};
  /// One a track; nothing: followed to the last frame. Empty of other people's tracks.
  std::vector<std::optional<TrackEnd>> ends = {};

  int frame_count() const { return static_cast<int>(raw_px.size()); }
  int track_count() const { return static_cast<int>(ids.size()); }
  bool seen(int frame, int track) const { return raw_px[frame].col(track).allFinite(); }
};

/// What is taken to be known of a window's rotations: all; all but a constant gyroscope bias (three
/// unknowns, Gaussian prior); nothing.
enum class RotationModel { known, bias, free };

template <>
struct ChoiceKeys<RotationModel> {
  static constexpr const char* option = "rotation model";
  static constexpr std::array keys{"known", "bias", "free"};
};

/// How rotations integrated from a gyroscope depend on what is not known of it:
/// R_wc(bias + db, offset + dt) ~ R_wc exp(d_bias db + d_offset dt), first order.
struct GyroSensitivity {
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();   ///< with which R_wc was integrated
  Eigen::Vector3d prior_rad_s = Eigen::Vector3d::Zero();  ///< what the sensor's data say of it
  double prior_sigma_rad_s = 0.01;                        ///< and how surely, each axis
  std::vector<Eigen::Matrix3d> d_bias;                    ///< one a frame, of its camera axes [s]
  std::vector<Eigen::Vector3d> d_offset;  ///< one a frame, of its camera axes [rad/s]
};

/// A window: all that an initializer may know. Frame 0 of it is the reference frame (frame 1 of the
/// paper), whose camera is the world. Immutable once made.
struct Window {
  int start = 0;                            ///< reference frame, counts in the recording
  Eigen::Matrix3d K;                        ///< of the undistorted image [px]
  std::vector<std::int64_t> timestamps_ns;  ///< one a frame
  std::vector<Eigen::Matrix2Xd> points_px;  ///< one a frame, 2 x tracks, undistorted; NaN: not seen
  std::vector<std::vector<bool>> inlier;    ///< one a frame and track: seen, and agrees with H_i1
  std::vector<Eigen::Matrix3d> H_i1;        ///< p_i ~ H_i1 p_1 by RANSAC [px]; H_11 = I
  Inliers inliers = Inliers::per_frame;     ///< how they were told
  std::vector<Eigen::Matrix3d> R_wc;        ///< given rotations, R_wc of frame 0 is I
  RotationModel rotations = RotationModel::known;  ///< what is uncertain of them
  std::optional<GyroSensitivity> gyro;             ///< of rotations from a gyroscope
  bool all_tracks = false;  ///< methods that need no plane use the tracks off it, too

  int frame_count() const { return static_cast<int>(points_px.size()); }
  int track_count() const { return static_cast<int>(points_px.front().cols()); }
  int inlier_count(int frame) const;
  /// Whether the track agrees with the homography in at least half of the frames that see it, the
  /// reference frame aside. These are the inliers that the results count and the points that they
  /// deliver.
  bool is_inlier_track(int track) const;
};

/// Undistorts the tracks once and rejects outliers between the reference frame and each other
/// frame, then also over the window where `inliers` says so and enough tracks are consistent.
/// Rotations are left at the identity. `recording_timestamps_ns` are those of all frames of the
/// recording.
Window make_window(const Tracks& tracks,
                   const Camera& camera,
                   std::span<const std::int64_t> recording_timestamps_ns,
                   const RansacOptions& ransac,
                   Inliers inliers = Inliers::per_frame);

/// As if the tracks with these ids had never been seen: NaN in every frame. Columns stay.
Tracks without(Tracks tracks, std::span<const std::int64_t> ids);

}  // namespace gpo
