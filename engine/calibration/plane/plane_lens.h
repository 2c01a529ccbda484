// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/frame_cache.h"
#include "engine/tracking/tracker.h"
#include "engine/window/gyroscope.h"

#include <cstdint>
#include <map>
#include <string>

namespace gpo {

/// The points of a plane that one image shows.
struct PlaneView {
  int frame = 0;            ///< index in the recording
  std::vector<int> points;  ///< indices of the plane's points, ascending
  Eigen::Matrix2Xd raw_px;  ///< one column a point
  /// Motion of each point from frame to frame [px], one column a point; 0 where it is unknown.
  Eigen::Matrix2Xd flow_px = Eigen::Matrix2Xd::Zero(2, raw_px.cols());
};

/// A plane with points at unknown places, and all images that show some of them.
struct ObservedPlane {
  int points = 0;
  std::vector<PlaneView> views;  ///< in the order of time
};

/// The first image of a window, with the tracks on its plane.
struct PlaneReference {
  int frame = 0;            ///< index in the recording
  Eigen::Matrix2Xd raw_px;  ///< 2 x points
};

/// A part of the recording through which one plane was followed.
struct PlaneChain {
  std::vector<PlaneReference> references;  ///< one per window, in the order of time
  /// Homography from the undistorted pixels of the first frame to those of each frame.
  std::map<int, Eigen::Matrix3d> H_i_first;
};

/// Every `step`-th image of a recording.
struct ChainImages {
  const FrameCache& cache;
  int step;
  FrameProgress progress;

  int count() const { return (cache.count() + step - 1) / step; }
};

/// Follows the plane with most tracks from window to window. Each window begins where the one
/// before ended and continues with the plane there; a lost plane ends the chain. `camera` is a
/// guess.
std::vector<PlaneChain> plane_chains(const ChainImages& images, const Camera& camera);

/// Returns the guess with the k1 for which most tracks of a few windows are on one plane: strong
/// distortion tears planes apart.
Camera with_likely_distortion(const ChainImages& images, const Camera& guess);

/// Returns at most `most` elements, spread evenly from the first to the last one.
template <typename T>
std::vector<T> spread(const std::vector<T>& all, int most) {
  const auto count = std::ssize(all);
  if (count <= most) return all;
  std::vector<T> some;
  for (std::ptrdiff_t k = 0; k < most; ++k) some.push_back(all[k * (count - 1) / (most - 1)]);
  return some;
}

/// Finds the points of a chain's references in at most `most_views` images of the chain by their
/// patches, warped by the homography from their reference: one set of points seen from everywhere.
ObservedPlane linked_views(const FrameCache& images,
                           const PlaneChain& chain,
                           const Camera& camera,
                           int most_views);

/// Camera rotation between two frames by the gyroscope, R_ab in camera axes. A change db of the
/// bias makes it R_ab exp(d_bias db), to first order.
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

/// The unknowns of lens and sensor, each of the order of 1: log(f / width), log(fy / fx), principal
/// point from the image center [widths], k1, k2, p1, p2, readout [frame intervals, negative from
/// below]. f is the geometric mean of fx and fy.
inline constexpr int kLensUnknowns = 9;
inline constexpr int kReadout = 8;
using LensVector = Eigen::Matrix<double, kLensUnknowns, 1>;
inline constexpr std::array<const char*, kLensUnknowns> kLensNames = {
    "f", "fy/fx", "cx", "cy", "k1", "k2", "p1", "p2", "readout"};

/// Gaussian prior of a lens.
struct LensPrior {
  LensVector mean = {-0.1, 0, 0, 0, 0, 0, 0, 0, 0};
  LensVector sigma = {1.0, 0.01, 0.04, 0.04, 0.3, 0.5, 0.003, 0.003, 0.5};
};

/// A plane's points (x, y, height), in units of the distance of its first view, and a pose (w, t)
/// of each view: x_c = exp(w) X + t.
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
};

/// All data of a least squares over lens, points and poses.
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

/// Minimizes over lens, points and poses (engine/method.md, 19). Two points of each plane fix the
/// gauge.
Adjustment adjust(const PlaneData& problem, const Adjustment& start);

/// Lengths of the reprojection errors [px] by plane, view and point; infinite behind the camera.
using ViewErrors = std::vector<std::vector<Eigen::VectorXd>>;
ViewErrors reprojection_errors(const PlaneData& problem, const Adjustment& adjustment);

struct LensCertainty {
  LensVector sigma;      ///< robust
  LensVector own_sigma;  ///< with independent observations
  /// With these standard deviations and the correlations of all clusterings together.
  Eigen::Matrix<double, kLensUnknowns, kLensUnknowns> covariance;
};

/// Estimates the uncertainty of an adjusted lens (engine/method.md, 20). The errors of a place of
/// a plane, of a region of the image, or of a stretch of time (a tenth of the views) count as one.
/// `noise_px` is the noise of one coordinate.
LensCertainty lens_certainty(const PlaneData& problem,
                             const Adjustment& adjustment,
                             double noise_px);

/// A plane's points in one image, and the homographies from there to all views. Undistorted pixels
/// relative to the image center.
struct PlaneMosaic {
  Eigen::Matrix2Xd points;             ///< NaN for points without a place
  std::vector<Eigen::Matrix3d> H_i_m;  ///< one per view; NaN for views without a place
};

/// Chains views, those with most points in common first. `camera` undistorts.
PlaneMosaic plane_mosaic(const ObservedPlane& plane, const Camera& camera);

/// Likely normals of the plane in the mosaic's view for a focal length, at most `most`, best first:
/// the first two columns of homographies from the plane, in Euclidean coordinates, are orthogonal
/// and of equal length (Triggs 1998).
std::vector<Eigen::Vector3d> likely_normals(const PlaneMosaic& mosaic, double focal_px, int most);

/// Points and poses of a plane with that normal by the mosaic; nullopt if it faces away.
std::optional<AdjustedPlane> start_of(const PlaneMosaic& mosaic,
                                      double focal_px,
                                      const Eigen::Vector3d& normal);

// These functions drop observations. Points and views keep their indices, so that an adjustment
// remains valid. A view may be left without a point.

/// Returns the planes without points in fewer than 3 views, views of fewer than 8 points, and
/// planes without observations.
std::vector<ObservedPlane> cleaned(std::vector<ObservedPlane> planes);

/// Returns the observations for which `is_kept(plane, view, column)`, without points in fewer than
/// 3 views and without views of fewer than 8 points.
std::vector<ObservedPlane> filtered(
    std::vector<ObservedPlane> planes,
    const std::function<bool(std::size_t plane, std::size_t view, int column)>& is_kept);

/// Returns a few views, spread evenly, and some of their points: enough to compare starts.
std::vector<ObservedPlane> thinned(const std::vector<ObservedPlane>& planes);

/// Returns the planes without errors above `most_px`, and without views with more than three times
/// the median error of all views. Appends the frames of the latter to `left_out`.
std::vector<ObservedPlane> without_far(const std::vector<ObservedPlane>& planes,
                                       const ViewErrors& errors,
                                       double most_px,
                                       std::vector<int>& left_out);

std::vector<double> finite(const ViewErrors& errors);
/// Noise of a coordinate [px], by the median error.
double noise_of(const ViewErrors& errors);

/// Distance of points from their planes, by the median of the observed ones [distances].
double height_of(const std::vector<ObservedPlane>& planes, const Adjustment& adjustment);

/// Returns the number of views that show each point.
std::vector<int> views_of_points(const ObservedPlane& plane);

struct PlaneCounts {
  int observations = 0;
  int views = 0;   ///< with at least one point
  int points = 0;  ///< in at least one view
};
PlaneCounts counts_of(const std::vector<ObservedPlane>& planes);

/// Share of a prior's standard deviation above which the images do not determine a parameter.
constexpr double kPriorOnly = 0.7;

/// Result of a calibration from planes of unknown structure.
struct PlaneLens {
  bool ok = false;
  std::string reason;  ///< why there is no camera
  Camera camera;       ///< with standard deviations
  LensVector lens = LensVector::Zero();
  LensVector sigma = LensVector::Zero();
  std::array<bool, kLensUnknowns> prior_only{};  ///< see `kPriorOnly`
  double rms_px = 0;                             ///< [raw px]
  int points = 0;
  int views = 0;
  double tilt_deg = 0;        ///< largest angle between the plane's normals in camera axes
  double moved = 0;           ///< largest camera motion [distances from the plane]
  std::vector<int> left_out;  ///< frames that disagree with the others
  bool gyroscope = false;     ///< whether a gyroscope contributed
};

/// Calibrates a camera by planar scenes (Triggs 1998; engine/method.md, "The lens from the plane").
/// Starts from several focal lengths, with the best normals of each, and then minimizes over lens,
/// points and poses. `guess` has the size of the images, roughly the lens distortion, and the
/// direction of the readout. Throws Stopped.
PlaneLens lens_from_planes(std::vector<ObservedPlane> planes,
                           const GyroRotations& gyro,
                           const Camera& guess,
                           const std::function<void(int done, int of)>& progress = {});

/// Receives the current step and its progress: "following a plane", 41 of 60.
using CalibrationProgress = std::function<void(const char* what, int done, int of)>;

/// Calibrates a camera by a plane in its images (engine/method.md, "The lens from the plane").
/// `guess` has the size of the images and roughly their field of view. The result has its readout
/// time if it has one, otherwise the one estimated from the images, for which the frames' times
/// (camera clock) are needed. `gyroscope` has its axes in those of the camera and needs them, too;
/// null if there is none. Throws InputError if an image cannot be decoded, and Stopped.
PlaneLens calibrate_from_plane(const FrameCache& images,
                               const Camera& guess,
                               std::span<const std::int64_t> frame_times_ns = {},
                               const Gyroscope* gyroscope = nullptr,
                               const CalibrationProgress& progress = {});

}  // namespace gpo
