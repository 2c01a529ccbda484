// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Which tracks count as on the plane: in each frame those that agree with its homography (the
/// paper); those that agree with the refined homographies in nearly all frames that see them; or
/// those of one of the planes that are told over the whole window.
enum class Inliers { per_frame, consistent, planes };

template <>
struct ChoiceKeys<Inliers> {
  static constexpr const char* name = "inliers";
  static constexpr std::array keys{"per-frame", "consistent", "planes"};
};

/// How a homography and the best rotation explain one frame's inliers.
struct FrameErrors {
  int inliers = 0;
  double homography_px = 0;       ///< median transfer error of the frame's homography
  double rotation_px = 0;         ///< the same of the best rotation
  double homography_squares = 0;  ///< summed over both coordinates [px^2]
  double rotation_squares = 0;    ///< [px^2]
};
/// What is taken to be known of a window's rotations: all; all but a constant gyroscope bias (three
/// unknowns, Gaussian prior); nothing.
enum class RotationModel { known, bias, free };

template <>
struct ChoiceKeys<RotationModel> {
  static constexpr const char* name = "rotation model";
  static constexpr std::array keys{"known", "bias", "free"};
};

/// How rotations integrated from a gyroscope depend on what is not known of it:
/// R_wc(bias + db, offset + dt) ~ R_wc exp(d_bias db + d_offset dt), first order.
struct GyroSensitivity {
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();   ///< with which R_wc was integrated
  Eigen::Vector3d prior_rad_s = Eigen::Vector3d::Zero();  ///< what the sensor's data say of it
  double prior_sigma_rad_s = 0.1;                         ///< and how surely, each axis
  /// Of `bias_rad_s`: what holds the rotations as they are is wrong by that.
  Eigen::Matrix3d bias_covariance = 0.01 * Eigen::Matrix3d::Identity();
  double noise_density = 0;               ///< of the rates, white [rad/s/sqrt(Hz)]
  std::vector<Eigen::Matrix3d> d_bias;    ///< one a frame, of its camera axes [s]
  std::vector<Eigen::Vector3d> d_offset;  ///< one a frame, of its camera axes [rad/s]
};

/// A plane of a window: tracks that keep to one homography a frame over all of it.
struct WindowPlane {
  std::vector<int> tracks;                ///< ascending; no track is in two planes
  std::vector<Eigen::Matrix3d> H_i1;      ///< one a frame, of these tracks [px]; NaN: too few
  std::vector<std::vector<bool>> inlier;  ///< one a frame and track: seen, and agrees with H_i1
  double image_share = 0;  ///< of the reference picture, what its tracks' convex hull covers [-]
  double stability = 1;      ///< share of its tracks that stay where the gate is halved [-]
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
  /// The plane with most tracks first; empty where inliers are not told by planes, or none was
  /// found.
  std::vector<WindowPlane> planes = {};
  int largest_refused = 0;  ///< tracks of the set that was not taken as a plane, where none was
  int leader = 0;  ///< the plane whose tracks are the inliers, and of whose distance is the gauge
  std::vector<Eigen::Matrix3d> R_wc;               ///< given rotations, R_wc of frame 0 is I
  RotationModel rotations = RotationModel::known;  ///< what is uncertain of them
  std::optional<GyroSensitivity> gyro;             ///< of rotations from a gyroscope
  /// One a frame, of the members above; empty: whoever needs them computes them (`frame_errors`).
  std::vector<FrameErrors> errors = {};
  /// How the points would move were one parameter of the lens larger by its standard deviation: of
  /// each parameter, as `points_px`. Empty: the lens is taken as exact.
  std::vector<std::vector<Eigen::Matrix2Xd>> lens_moves_px = {};
  bool all_tracks = false;  ///< methods that need no plane use the tracks off it, too

  int frame_count() const { return static_cast<int>(points_px.size()); }
  int track_count() const { return static_cast<int>(points_px.front().cols()); }
  int inlier_count(int frame) const;
  /// Those of a frame, ascending.
  std::vector<int> inlier_tracks(int frame) const;
  /// Whether the track agrees with the homography in at least half of the frames that see it, the
  /// reference frame aside. These are the inliers that the results count and the points that they
  /// deliver.
  bool is_inlier_track(int track) const;
  /// Number of the plane that the track lies on over the whole window; nothing: on none.
  std::optional<int> plane_of(int track) const;
};

}  // namespace gpo
