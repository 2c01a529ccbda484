// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// How the inliers of the plane are chosen. per_frame: tracks that agree with the homography of
/// each frame (the paper); consistent: tracks that agree with the refined homographies in nearly
/// all frames; planes: tracks of one of the planes found over the whole window.
enum class Inliers { per_frame, consistent, planes };

template <>
struct ChoiceKeys<Inliers> : NamedKeys<"inliers", "per-frame", "consistent", "planes"> {};

/// Errors that a homography and the best pure rotation leave at the inliers of one frame.
struct FrameErrors {
  int inliers = 0;
  double homography_px = 0;       ///< median transfer error of the frame's homography
  double rotation_px = 0;         ///< the same for the best rotation
  double homography_squares = 0;  ///< summed over both coordinates [px^2]
  double rotation_squares = 0;    ///< [px^2]
};

/// How well the rotations of a window are known. known: exactly; bias: up to a constant gyroscope
/// bias (three unknowns, Gaussian prior); free: not at all.
enum class RotationModel { known, bias, free };

template <>
struct ChoiceKeys<RotationModel> : NamedKeys<"rotation model", "known", "bias", "free"> {};

/// Derivatives of integrated gyroscope rotations:
/// R_wc(bias + db, offset + dt) ~ R_wc exp(d_bias db + d_offset dt + d2_offset dt^2 / 2).
struct GyroSensitivity {
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();   ///< used to integrate R_wc
  Eigen::Vector3d prior_rad_s = Eigen::Vector3d::Zero();  ///< bias from the sensor's own data
  double prior_sigma_rad_s = 0.1;  ///< standard deviation of `prior_rad_s`, each axis
  /// Covariance of `bias_rad_s`, before the tracks are seen; for methods that hold the rotations.
  Eigen::Matrix3d bias_covariance = 0.01 * Eigen::Matrix3d::Identity();
  double time_offset_s = 0;  ///< used to integrate R_wc: gyroscope clock = camera clock + offset
  /// Standard deviation of the offset between the clocks of camera and gyroscope; 0: exact.
  double time_offset_sigma_s = 0;
  double noise_density = 0;                ///< white noise of the rates [rad/s/sqrt(Hz)]
  std::vector<Eigen::Matrix3d> d_bias;     ///< one per frame, in its camera axes [s]
  std::vector<Eigen::Vector3d> d_offset;   ///< one per frame, in its camera axes [rad/s]
  std::vector<Eigen::Vector3d> d2_offset;  ///< the same [rad/s^2]
};

/// Prior of the time from one row of the recorded image to the next [s]; from one column to the
/// next if columns are read (`Window::readout_direction`).
struct RowDelayPrior {
  double mean_s = 0;
  double sigma_s = 0;
};

/// A plane of a window: tracks that agree with one homography per frame over the whole window.
struct WindowPlane {
  std::vector<int> tracks;                ///< ascending; no track is in two planes
  std::vector<Eigen::Matrix3d> H_i1;      ///< one per frame, from these tracks [px]; NaN: too few
  std::vector<std::vector<bool>> inlier;  ///< one per frame and track: observed, agrees with H_i1
  double image_share = 0;  ///< share of the reference image inside the tracks' convex hull [-]
  double stability = 1;    ///< share of its tracks that stay if the gate is halved [-]
};

/// The input of every initializer. Frame 0 is the reference frame (frame 1 of the paper), whose
/// camera is the world. Immutable once made.
struct Window {
  int start = 0;                            ///< reference frame, index in the recording
  Eigen::Matrix3d K;                        ///< intrinsics of the undistorted image [px]
  int width = 0, height = 0;                ///< size of the recorded image [px]; 0: unknown
  std::vector<std::int64_t> timestamps_ns;  ///< one per frame
  std::vector<Eigen::Matrix2Xd> points_px;  ///< one per frame, 2 x tracks, undistorted; NaN: lost
  /// Standard deviation of each observation over the root mean square of all; one vector per frame.
  /// Empty: equal. The joint model weights by it, and the selection of inliers widens gates; other
  /// methods weigh all alike.
  std::vector<Eigen::VectorXd> noise_ratio = {};
  /// Row of each observation in the recorded image [px], counted along `readout_direction` from the
  /// row of the time stamp, the image center; one vector per frame. Empty: those of `points_px`,
  /// counted from the principal point.
  std::vector<Eigen::VectorXd> rows = {};
  int image_rows = 0;  ///< number of rows of the recorded image, or columns if read; 0: unknown
  /// Columns of tracks that do not move in the image although the others predict it, ascending.
  /// They are left out: their points are NaN (`static_tracks`, engine/planes/inliers.h).
  std::vector<int> static_tracks = {};
  std::vector<std::vector<bool>> inlier;  ///< one per frame and track: observed, agrees with H_i1
  std::vector<Eigen::Matrix3d> H_i1;      ///< p_i ~ H_i1 p_1 by RANSAC [px]; H_11 = I
  Inliers inliers = Inliers::per_frame;   ///< how `inlier` was chosen
  double threshold_px = 2;                ///< largest transfer error of an inlier
  /// Largest plane first; empty if inliers are not chosen by planes, or if none was found.
  std::vector<WindowPlane> planes = {};
  int largest_refused = 0;  ///< tracks of the largest set that was rejected, if no plane was found
  int leader = 0;           ///< main plane: its tracks are the inliers, its distance is the gauge
  std::vector<Eigen::Matrix3d> R_wc;               ///< given rotations, R_wc of frame 0 is I
  RotationModel rotations = RotationModel::known;  ///< how well they are known
  std::optional<GyroSensitivity> gyro;             ///< if the rotations are from a gyroscope
  /// Change of the points for one standard deviation of each independent error of the lens (a
  /// parameter, or a column of `lens_root`); each as `points_px`. Empty if the calibration states
  /// no uncertainty.
  std::vector<std::vector<Eigen::Matrix2Xd>> lens_moves_px = {};
  bool camera_is_guess = false;                           ///< see `typical_lens_moves_px`
  std::optional<RowDelayPrior> row_delay = std::nullopt;  ///< nullopt: unknown
  /// Unit vector in the image: points further along it are read later.
  Eigen::Vector2d readout_direction = Eigen::Vector2d::UnitY();
  /// Change of the points for one standard deviation of the row delay that they were corrected
  /// for, in the form of an element of `lens_moves_px`; empty if they were not, or if it is exact.
  std::vector<Eigen::Matrix2Xd> row_delay_moves_px = {};
  double selection_row_delay_s = 0;  ///< compensated when inliers were selected; the points are not
  bool exact_reference = false;      ///< points of frame 0 have no noise (anchored tracks)
  bool all_tracks = false;  ///< methods that need no plane also use the tracks off the plane

  int frame_count() const { return static_cast<int>(points_px.size()); }
  int track_count() const { return static_cast<int>(points_px.front().cols()); }
  /// Returns `noise_ratio` of an observation.
  double noise_ratio_of(int frame, int track) const {
    return noise_ratio.empty() ? 1 : noise_ratio[frame][track];
  }
  /// Returns `rows` of an observation.
  double row_of(int frame, int track) const {
    if (!rows.empty()) return rows[frame][track];
    return readout_direction.dot(points_px[frame].col(track) - K.topRightCorner<2, 1>());
  }
  /// Returns `image_rows`, or those of an image with the principal point in its middle.
  double row_count() const {
    if (image_rows > 0) return image_rows;
    return 2 * std::abs(readout_direction.dot(K.topRightCorner<2, 1>())) + 1;
  }
  /// Returns the factor of the gate of an observation: the root mean square ratio of it and the one
  /// in the reference frame, at least 1, because homographies are fitted without weights.
  double gate_factor(int frame, int track) const;
  int inlier_count(int frame) const;
  /// Returns the inlier tracks of a frame, ascending.
  std::vector<int> inlier_tracks(int frame) const;
  /// Returns true if the track is an inlier in at least half of the frames that observe it, without
  /// the reference frame. Results count these tracks and return their points.
  bool is_inlier_track(int track) const;
  /// Returns the index of the plane that contains the track; nullopt if none does.
  std::optional<int> plane_of(int track) const;
};

/// Returns the size of the recorded image [px]; if unknown, that of an image with the principal
/// point in its middle, or of a usual lens if a coordinate of that is not above zero.
Eigen::Vector2d image_size_px(const Window& window);
/// Returns the `pixel_unit` of the recorded image.
double pixel_unit(const Window& window);

/// Returns the change of the points for one standard deviation of each parameter of a typical
/// calibration, in the form of `lens_moves_px`: focal length 0.3 %, principal point 0.3 % of the
/// image width, and radial distortion that moves the corners by 0.5 `pixel_unit` (third and fifth
/// power of the radius). A guess is taken as 20 %, 2 %, and 3 % of the corner's distance off.
std::vector<std::vector<Eigen::Matrix2Xd>> typical_lens_moves_px(const Window& window);

/// Returns whether a track that starts in the reference frame has no observation in a frame of the
/// window. Excluded tracks have none at all and are not lost.
bool is_lost(const Window& window, int frame, int track);
int lost_count(const Window& window, int frame);

/// Returns the errors of a frame; zero for the reference frame and for frames without inliers.
FrameErrors frame_errors(const Window& window, int frame);

/// Fits the homographies again to their inliers; those of frames with fewer than eight stay.
void refine_homographies(Window& window);

/// Returns the median over the frames of the inliers' median homography transfer error [px].
double homography_error_px(const Window& window);

}  // namespace gpo
