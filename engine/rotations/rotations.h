// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/window/gyroscope.h"
#include "engine/window/window.h"

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Camera rotations of a window, or the reason why there are none.
struct Rotations {
  std::vector<Eigen::Matrix3d> R_wc = {};  ///< one per frame, I in the first; empty: none
  std::string reason = "";
  RotationModel model = RotationModel::known;          ///< their uncertain parts
  std::optional<GyroSensitivity> gyro = std::nullopt;  ///< for rotations from a gyroscope
  double sigma_rad = 0;   ///< rough, of rotations from images (R_wc_images)
  bool stopped = false;   ///< there are none because of that
  std::string note = "";  ///< how an ambiguity was resolved, if any
  /// Rotations by images alone that calibrated a gyroscope, one per frame; empty for other sources.
  std::vector<Eigen::Matrix3d> R_wc_images = {};
  /// Rotations by the other one of two equally good plane orientations; empty if one is clear.
  std::vector<Eigen::Matrix3d> R_wc_other = {};
  double orientations_apart_deg = 0;  ///< angle between the planes of `R_wc` and `R_wc_other`
};

/// automatic: a gyroscope, calibrated if the images can; without one five-point rotations if the
/// scene has more than one plane, else averaging. raw: an uncalibrated gyroscope, else averaging.
/// averaging uses decomposed homographies. If these fit two plane orientations equally well, the
/// results of both decide; _first and _second take one of them, the first one fits slightly better.
/// five_point and direct use all tracks.
enum class RotationSource {
  automatic,
  raw,
  gyro,
  gyro_calibrated,
  averaging,
  averaging_first,
  averaging_second,
  five_point,
  direct,
  truth
};

template <>
struct ChoiceKeys<RotationSource> : NamedKeys<"rotations",
                                              "automatic",
                                              "raw",
                                              "gyro",
                                              "gyro-calibrated",
                                              "averaging",
                                              "averaging-first",
                                              "averaging-second",
                                              "five-point",
                                              "direct",
                                              "truth"> {};

/// Returns whether the source integrates a gyroscope.
bool needs_gyroscope(RotationSource source);

/// Returns R_wc at each time, with the first camera as world: mid-point integration of (w - bias)
/// on SO(3), interpolated at the frame times (engine/method.md, eq. 5). Throws InputError if the
/// samples do not cover the times or leave a gap of more than five sample periods.
std::vector<Eigen::Matrix3d> gyro_rotations(const Gyroscope& gyroscope,
                                            std::span<const std::int64_t> frame_times_ns);

/// The same with derivatives by bias and clock offset and the gyroscope's own prior of the bias.
Rotations sensitive_gyro_rotations(const Gyroscope& gyroscope,
                                   std::span<const std::int64_t> frame_times_ns);

struct GyroBias {
  Eigen::Vector3d bias_rad_s;  ///< in the gyroscope's axes
  Eigen::Matrix3d covariance;  ///< [(rad/s)^2]
};

/// Estimates the constant bias whose integrated rotations fit the visual ones best: robust least
/// squares over the frames, with a Gaussian prior at the gyroscope's own bias (`bias_sigma_rad_s`).
/// Errors of the visual rotations are correlated through the plane's normal, so all frames together
/// weigh as one: a short or ill-conditioned window keeps the gyroscope's own bias.
GyroBias fit_gyro_bias(const Gyroscope& gyroscope,
                       std::span<const std::int64_t> frame_times_ns,
                       const Rotations& visual);

/// Integrates a gyroscope with a constant bias estimated from the window's averaged homography
/// decompositions, among which the gyroscope selects the plane. Empty, with a reason, if there are
/// no visual rotations.
Rotations calibrated_gyro_rotations(const Gyroscope& gyroscope,
                                    const Window& window,
                                    const std::stop_token& stop = {});

/// Estimates the rotations of a window's cameras from its images alone: decomposes homographies
/// between pairs of frames, selects the candidates whose plane normal agrees over the window, and
/// averages their rotations. On a plane these are far more accurate than five-point rotations
/// (`tests/engine/rotations/rotations_test.cpp` measures both). Roughly known rotations
/// (one per frame, e.g. a gyroscope's) resolve ambiguities; without any, another plane may, else
/// `R_wc_other` has the second orientation. Empty, with a reason, if the homographies allow no
/// consistent choice, or if stopped.
Rotations averaged_rotations(const Window& window,
                             const std::stop_token& stop = {},
                             std::span<const Eigen::Matrix3d> R_wc_given = {});

/// Minimal solver of relative poses: Nister's five-point algorithm, or the eigensolver of Kneip and
/// Lynen 2013, which optimizes the rotation alone from a guess.
enum class RelativeSolver { five_point, eigensolver };

struct PairRotationOptions {
  RelativeSolver solver = RelativeSolver::five_point;
  double threshold_px = 2.0;  ///< largest distance of an inlier from the epipolar geometry [px]
  std::uint64_t seed = 1;     ///< for the random samples
};

/// Estimates the rotations of a window's cameras from all its tracks, on any surface: relative
/// poses of pairs of frames by RANSAC, whose rotations are averaged (Chatterjee & Govindu). Empty,
/// with a reason, if one plane explains nearly all tracks and makes them ambiguous, if too few
/// tracks join a frame to the first one, or if stopped.
Rotations pair_rotations(const Window& window,
                         const PairRotationOptions& options,
                         const std::stop_token& stop = {});

/// Tracks that frames i and j see.
struct RayPairs {
  Eigen::Matrix3Xd i;      ///< K^-1 p, third coordinate 1, 3 x n
  Eigen::Matrix3Xd j;      ///< 3 x n
  std::vector<int> group;  ///< surface that each track may lie on, counted from 0
};

struct RelativePoseOptions {
  RelativeSolver solver = RelativeSolver::five_point;
  double gate = 0.004;  ///< largest Sampson distance of an inlier, in units of K^-1 p [-]
  Eigen::Matrix3d R_ij_guess = Eigen::Matrix3d::Identity();
  std::uint64_t seed = 1;
};

/// x_i ~ R_ij x_j + s direction; s has either sign if the camera hardly moved.
struct RelativePose {
  Eigen::Matrix3d R_ij;
  Eigen::Vector3d direction;  ///< to camera j, in frame i, unit length, up to its sign
  std::vector<bool> inlier;   ///< one per track
  int inliers = 0;
};

/// Estimates a relative pose by RANSAC over a solver's proposals and refines it by the weighted
/// eigensolver, which minimizes Sampson's error over the inliers. Half of the samples draw from all
/// groups so that a plane with nearly all tracks does not dominate. Returns nullopt if fewer than
/// `kLeastPairRays` agree.
std::optional<RelativePose> relative_pose(const RayPairs& rays, const RelativePoseOptions& options);

inline constexpr int kLeastPairRays = 12;

/// Returns squared first-order distances to the epipolar geometry, one per track (Hartley &
/// Zisserman, 11.9).
Eigen::ArrayXd squared_sampson_distances(const Eigen::Matrix3d& E, const RayPairs& rays);

/// Measured rotation between two frames: x_i = R_ij x_j for directions.
struct RelativeRotation {
  int i;
  int j;
  Eigen::Matrix3d R_ij;
  double weight = 1;  ///< inverse variance, any unit
};

/// Numbers of frames between those whose relative rotations are averaged, besides all pairs with
/// the reference frame. In simulated windows more pairs are no more accurate.
inline constexpr int kPairLengths[] = {1, 4, 16, 64};

/// Averages rotations robustly (Chatterjee & Govindu, ICCV 2013), starting from `R_wc`: least
/// absolute deviations, then iteratively reweighted least squares. Frame 0 keeps its rotation.
std::vector<Eigen::Matrix3d> average_rotations(std::span<const RelativeRotation> relative,
                                               std::vector<Eigen::Matrix3d> R_wc);

}  // namespace gpo
