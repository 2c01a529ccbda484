// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/tracking/tracker.h"
#include "engine/recording/frame_cache.h"
#include "engine/window/gyroscope.h"

#include <cstdint>
#include <map>
#include <string>

namespace gpo {

struct PlaneView {
  int frame = 0;            ///< index in the recording
  std::vector<int> points;  ///< indices of the plane's points, ascending
  Eigen::Matrix2Xd raw_px;  ///< one column a point
  Eigen::Matrix2Xd flow_px = Eigen::Matrix2Xd::Zero(2, raw_px.cols());
};

struct ObservedPlane {
  int points = 0;
  std::vector<PlaneView> views;  ///< in the order of time
};

struct PlaneReference {
  int frame = 0;            ///< index in the recording
  Eigen::Matrix2Xd raw_px;  ///< 2 x points
};

struct PlaneChain {
  std::vector<PlaneReference> references;  ///< one a window, in the order of time
  /// Homography from the undistorted pixels of the first frame to those of each frame.
  std::map<int, Eigen::Matrix3d> H_i_first;
};

struct ChainImages {
  GrayImages gray;  ///< by frame of the recording
  int frames = 0;   ///< number of frames in the recording
  int step = 1;
  FrameProgress progress;
  std::stop_token stop;
};

/// Follows the plane with most tracks; losing it ends a chain. Incomplete if stopped.
std::vector<PlaneChain> plane_chains(const ChainImages& images, const Camera& camera);

Camera with_likely_distortion(const ChainImages& images, const Camera& guess);

/// Finds a chain's points in at most `most_views` images by patches warped from their reference.
ObservedPlane linked_views(const ChainImages& images,
                           const PlaneChain& chain,
                           const Camera& camera,
                           int most_views);

/// Rotation between two frames in camera axes; a bias change db makes it R_ab exp(d_bias db).
struct GyroRotation {
  int from = 0;  ///< frame
  int to = 0;    ///< frame
  Eigen::Matrix3d R_from_to = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d d_bias = Eigen::Matrix3d::Zero();  ///< [s]
  double sigma_rad = 1e-3;
};
struct GyroRotations {
  std::vector<GyroRotation> rotations;  ///< empty without a gyroscope
  double bias_sigma_rad_s = 0.1;        ///< prior of db, each axis
};

/// Unknowns, each of the order of 1: log(f / width), log(fy / fx), principal point from the image
/// center [widths], k1, k2, p1, p2, readout [frame intervals]. f: geometric mean of fx and fy.
inline constexpr int kLensUnknowns = 9;
inline constexpr int kReadout = 8;
using LensVector = Eigen::Matrix<double, kLensUnknowns, 1>;
inline constexpr std::array<const char*, kLensUnknowns> kLensNames = {
    "f", "fy/fx", "cx", "cy", "k1", "k2", "p1", "p2", "readout"};

struct LensPrior {
  LensVector mean = {-0.1, 0, 0, 0, 0, 0, 0, 0, 0};
  LensVector sigma = {1.0, 0.01, 0.04, 0.04, 0.3, 0.5, 0.003, 0.003, 0.5};
};

/// A plane's points (x, y, height) [distance of its first view], and poses: x_c = exp(w) X + t.
struct AdjustedPlane {
  Eigen::Matrix3Xd points;
  std::vector<Eigen::Matrix<double, 6, 1>> poses;
};
struct Adjustment {
  LensVector lens = LensVector::Zero();
  std::vector<AdjustedPlane> planes;
  Eigen::Vector3d bias_change_rad_s = Eigen::Vector3d::Zero();  ///< gyroscope axes
  double cost = 0;  ///< half the sum of the loss over all residuals [px^2]
  bool usable = false;
};

struct PlaneAdjustmentOptions {
  double knee_px = 1;       ///< knee of Huber's loss on the length of a residual
  double prior_px = 1;      ///< residual that weighs as much as one sigma of a prior
  double noise_px = 1;      ///< the same for the prior of the heights
  double height_sigma = 0;  ///< prior of heights above a plane [distances]; 0 for flat planes
  int most_iterations = 40;
  bool holds_distortion = false;  ///< keeps distortion coefficients and readout
  std::stop_token stop = {};
};

struct PlaneData {
  std::vector<ObservedPlane> planes;
  const GyroRotations& gyro;
  int width;   ///< [px]
  int height;  ///< [px]
  LensPrior prior = {};
  PlaneAdjustmentOptions options = {};
  Eigen::Vector2d readout_direction = Eigen::Vector2d::UnitY();
};

Camera camera_of(const LensVector& lens, int width, int height);
LensVector lens_of(const Camera& camera);

/// Minimizes over lens, points and poses (engine/method.md, 19); two points fix a plane's gauge.
Adjustment adjust(const PlaneData& problem, const Adjustment& start);

/// Lengths of the reprojection errors [px] by plane, view and point; infinite behind the camera.
using ViewErrors = std::vector<std::vector<Eigen::VectorXd>>;
ViewErrors reprojection_errors(const PlaneData& problem, const Adjustment& adjustment);

struct LensCertainty {
  LensVector sigma;      ///< robust
  LensVector own_sigma;  ///< with independent observations
  /// With these standard deviations and the correlations of both clusterings together.
  Eigen::Matrix<double, kLensUnknowns, kLensUnknowns> covariance;
};

/// Errors of a point, and those of a tenth of the views, count as one (engine/method.md, 20).
LensCertainty lens_certainty(const PlaneData& problem,
                             const Adjustment& adjustment,
                             double noise_px);

/// A plane's points in one image [undistorted px from the center], and homographies to all views.
struct PlaneMosaic {
  Eigen::Matrix2Xd points;             ///< NaN for points without a place
  std::vector<Eigen::Matrix3d> H_i_m;  ///< one a view; NaN for views without a place
};

PlaneMosaic plane_mosaic(const ObservedPlane& plane, const Camera& camera);

/// Likely normals in the mosaic's view, best first (Triggs 1998).
std::vector<Eigen::Vector3d> likely_normals(const PlaneMosaic& mosaic, double focal_px, int most);

/// Points and poses of a plane with that normal by the mosaic; nullopt if it faces away.
std::optional<AdjustedPlane> start_of(const PlaneMosaic& mosaic,
                                      double focal_px,
                                      const Eigen::Vector3d& normal);

// These drop observations. Points and views keep their indices; a view may be left without points.

/// Returns the planes without points in fewer than 3 views and views of fewer than 8 points.
std::vector<ObservedPlane> cleaned(std::vector<ObservedPlane> planes);

/// Returns the observations for which `is_kept(plane, view, column)`, cleaned in each plane.
std::vector<ObservedPlane> filtered(
    std::vector<ObservedPlane> planes,
    const std::function<bool(std::size_t plane, std::size_t view, int column)>& is_kept);

std::vector<ObservedPlane> thinned(const std::vector<ObservedPlane>& planes);

/// Drops errors above `most_px`, and views of three times the median error, added to `left_out`.
std::vector<ObservedPlane> without_far(const std::vector<ObservedPlane>& planes,
                                       const ViewErrors& errors,
                                       double most_px,
                                       std::vector<int>& left_out);

std::vector<double> finite(const ViewErrors& errors);
/// Noise of a coordinate [px], by the median error.
double noise_of(const ViewErrors& errors);

/// Distance of points from their planes, by the median of the observed ones [distances].
double height_of(const std::vector<ObservedPlane>& planes, const Adjustment& adjustment);

std::vector<int> views_of_points(const ObservedPlane& plane);

struct PlaneCounts {
  int observations = 0;
  int views = 0;   ///< with at least one point
  int points = 0;  ///< in at least one view
};
PlaneCounts counts_of(const std::vector<ObservedPlane>& planes);

struct PlaneLens {
  bool ok = false;
  bool stopped = false;
  std::string reason;  ///< why there is no camera
  Camera camera;       ///< with standard deviations
  LensVector lens = LensVector::Zero();
  LensVector sigma = LensVector::Zero();
  std::array<bool, kLensUnknowns> prior_only{};  ///< not determined by the images
  double rms_px = 0;                             ///< [raw px]
  int points = 0;
  int views = 0;
  double tilt_deg = 0;        ///< largest angle between the plane's normals in camera axes
  double moved = 0;           ///< largest camera motion [distances from the plane]
  std::vector<int> left_out;  ///< frames that disagree with the others
};

/// Calibrates by planar scenes; `guess` has size, rough distortion, and direction of the readout.
PlaneLens lens_from_planes(std::vector<ObservedPlane> planes,
                           const GyroRotations& gyro,
                           const Camera& guess,
                           const std::function<void(int done, int of)>& progress = {},
                           const std::stop_token& stop = {});

struct SelfCalibration {
  PlaneLens lens;
  bool gyroscope = false;  ///< whether a gyroscope contributed
};

using CalibrationProgress = std::function<void(const char* what, int done, int of)>;

/// A gyroscope in camera axes, null if there is none, and the frames' times (camera clock).
struct TimedGyroscope {
  const Gyroscope* gyroscope = nullptr;
  std::span<const std::int64_t> frame_times_ns = {};
};

/// Calibrates by a plane in the images. `guess` has their size and roughly their field of view. The
/// readout time is the guess's or, with the frames' times, estimated. Throws InputError.
SelfCalibration calibrate_from_plane(const FrameCache& images,
                                     const Camera& guess,
                                     const TimedGyroscope& timed = {},
                                     const CalibrationProgress& progress = {},
                                     const std::stop_token& stop = {});

}  // namespace gpo
