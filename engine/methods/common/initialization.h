// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/geometry/homography.h"
#include "engine/geometry/lens_residual.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/window/window.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Assumption of a verdict if the calibration states no uncertainty: the errors of a typical one
/// (`typical_lens_moves_px`), or an exact lens.
enum class Lens { typical, exact };

template <>
struct ChoiceKeys<Lens> : NamedKeys<"lens", "typical", "exact"> {};

/// Uncertainty of a plane other than the main plane.
struct PlaneUncertainty {
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Zero();  ///< [rad^2], rank 2
  double log_distance_sigma = 0;  ///< sigma of log(distance from the reference camera) [-]
};

/// Covariances of an estimate by the noise of the tracks, in the gauge of an initialization.
struct NoiseSpread {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();  ///< along `normal_tangents` [rad^2]
  std::vector<Eigen::Matrix3d> centers = {};         ///< for p_wc, one per frame
  std::vector<double> distance_ratios = {};          ///< variances of d_i / d_1, one per frame
  /// Half of the runs without a region of the image fail or end in another minimum: no covariances.
  bool unstable = false;
};

/// Moves of a solution by one standard deviation of each parameter of a typical calibration
/// (`typical_lens_moves_px`), one per column.
struct TypicalLensMoves {
  Eigen::MatrixXd results = {};      ///< rows as those of `Uncertainty::joint_covariance`
  Eigen::MatrixXd poses = {};        ///< rows as those of `pose_covariance`
  Eigen::MatrixXd row_delay_s = {};  ///< one row; none if it was no unknown
};

/// Uncertainty of a solution (engine/method.md, eq. 13 to 15) in the gauge of an initialization
/// (world = reference camera, d = 1), the unknowns of `rotations` marginalized. Its shape is that
/// of first-order covariances with two-way clustering: errors of a track in all its frames may be
/// correlated, and so may errors of all tracks in a frame. Its size is at least that of runs
/// without each region of the image (`with_size`). If the method takes uncertain rotations as
/// known, their uncertainty given the tracks is propagated. The lens has the uncertainty of its
/// calibration. Without one it is taken as exact until `add_typical_lens`.
struct Uncertainty {
  /// True: the uncertainty of the method's own estimates. False: that of the most accurate
  /// estimates from the window's tracks, at the method's solution.
  bool own = false;
  double sigma_px = 0;  ///< noise of a coordinate, from the residuals and degrees of freedom
  int tracks = 0;       ///< with observations
  RotationModel rotations = RotationModel::known;
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Zero();  ///< [rad^2], rank 2
  double normal_sigma_deg = 0;                                  ///< root of its trace
  /// Contribution of a curved surface, if it exceeds that of the regions. Before `with_size` the
  /// variation of the normal over the tracks, if significant.
  std::optional<double> bend_sigma_deg;
  /// Contribution of errors that neighboring tracks share, if regions of the image disagree.
  std::optional<double> neighbors_sigma_deg;
  /// Contribution of the gyroscope's clock, if the method takes it as exact and the tracks do not.
  std::optional<double> clock_sigma_deg;
  std::optional<double> late_s;  ///< time offset of that clock by the tracks
  /// Contribution of an uncertain readout, or of a rolling shutter that the method takes as global.
  std::optional<double> shutter_sigma_deg;
  std::optional<double> neglected_row_delay_s;  ///< its row delay: the camera's or the tracks'
  std::optional<double> lens_sigma_deg;  ///< contribution of the lens; nullopt if taken as exact
  /// The normal's standard deviation with a typical error of the calibration
  /// (`typical_lens_moves_px`); nullopt if the calibration has standard deviations.
  std::optional<double> typical_lens_sigma_deg;
  TypicalLensMoves typical_lens_moves;  ///< empty if the calibration has standard deviations
  bool includes_typical_lens = false;   ///< true after `add_typical_lens`
  bool has_size = false;                ///< true after `with_size`
  std::vector<Eigen::Matrix3d> center_covariances;  ///< for p_wc, one per frame; the first is zero
  /// Contribution of the tracks' noise and neighbors, given the rotations that the method holds.
  NoiseSpread noise;
  /// Joint covariance of all p_wc but the first, stacked; then of the gyroscope bias (3 rows, if
  /// uncertain) and its time offset (1 row, if uncertain); then for each plane, main plane first,
  /// of the normal along `normal_tangents` (2 rows) and, except for the main plane, of log(1 /
  /// distance). By noise and lens, without errors of neighbors and surfaces. Empty if not
  /// computed.
  Eigen::MatrixXd joint_covariance;
  /// 3 if `joint_covariance` contains the bias, 4 if also the time offset.
  int joint_bias_rows = 0;
  /// Joint covariance of the cameras but the first, six rows each: the rotation phi of
  /// R_wc exp(phi) [rad], then p_wc. Empty if not computed (`pose_prior`, engine/map.h).
  Eigen::MatrixXd pose_covariance;
  std::vector<double> distance_ratio_sigmas;       ///< for d_i / d_1, the distance from camera i
  std::vector<PlaneUncertainty> others;            ///< further planes, in their order
  std::optional<Eigen::Matrix3d> bias_covariance;  ///< [(rad/s)^2], gyroscope axes
  std::optional<double> time_offset_sigma_s;       ///< if the clocks' offset was an unknown
  std::optional<double> row_delay_sigma_s;         ///< if it was an unknown
  /// Cramér-Rao bounds of the normal's angle [deg] at this solution.
  std::optional<double> bound_known_rotations_deg;
  /// With a gyroscope only; its time offset is unknown, too, unless it is exact.
  std::optional<double> bound_unknown_bias_deg;
};

/// Sets the normal's covariance and standard deviations; the lens keeps its contribution.
void set_normal_covariance(const Eigen::Matrix3d& covariance, Uncertainty& uncertainty);

/// Returns the normal's standard deviation that a verdict depends on [deg].
double normal_sigma_deg(const Uncertainty& uncertainty, Lens lens);

/// Suitability of a window for initialization.
enum class Readiness { ready, weak, degenerate, no_plane };

template <>
struct ChoiceKeys<Readiness> : NamedKeys<"readiness", "ready", "weak", "degenerate", "no plane"> {};

/// Surfaces that the tracks of a window are on.
enum class SceneKind { unknown, one_plane, several_planes, no_plane };

template <>
struct ChoiceKeys<SceneKind>
    : NamedKeys<"scene", "not told", "one plane", "several planes", "no plane"> {};

/// Torr's GRIC (1998) of two models of all tracks, between the reference frame and the frame with
/// the farthest camera; the lower one is better.
struct SceneCriterion {
  double planes = 0;       ///< each track on one of the window's planes
  double free_points = 0;  ///< each track a free point, by the epipolar geometry of the cameras
};

/// Verdict on a window with the numbers it depends on; nullopt if not computed.
struct Verdict {
  Readiness readiness = Readiness::degenerate;
  std::string reason = {};  ///< one sentence with numbers, for people
  /// The result's, with the lens assumed (`Lens`); without a result the window's.
  std::optional<double> normal_sigma_deg{};
  std::optional<double> rotation_rms_px{};      ///< residual of the best rotation of each frame
  std::optional<double> noise_px{};             ///< one coordinate, residual of the homographies
  std::optional<double> largest_translation{};  ///< largest |tau| [plane distance]
  SceneKind scene = SceneKind::unknown;         ///< known if inliers are chosen by planes
  std::optional<SceneCriterion> criterion = std::nullopt;
};

enum class Termination { none, convergence, no_convergence, failure };

template <>
struct ChoiceKeys<Termination>
    : NamedKeys<"termination", "none", "convergence", "no_convergence", "failure"> {};

struct MapPoint {
  int track;                 ///< column in the window
  Eigen::Vector3d position;  ///< in the world, on or near the plane
};

/// State after an iteration of a solver.
struct SolverStep {
  double cost = 0;                        ///< half the weighted sum of squares [px^2]
  double gradient = 0;                    ///< largest component [px^2 per unit of the unknown]
  double step = 0;                        ///< length over all unknowns; 0 if the step was rejected
  std::optional<Eigen::Vector3d> normal;  ///< plane normal; nullopt without a plane
};

struct SolverReport {
  int iterations = 0;
  double initial_cost = 0;  ///< half the summed squares [px^2]
  double final_cost = 0;    ///< half the summed squares [px^2]
  int unknowns = 0;
  int residuals = 0;
  Termination termination = Termination::none;  ///< none for methods that do not optimize
  double milliseconds = 0;
  /// The start, then one entry per iteration; empty for methods that do not optimize. A rejected
  /// step repeats the previous state with step 0. Ceres counts the start in `iterations` and omits
  /// a last step below its tolerance. Rounds with other weights, a robust loss or fewer
  /// observations are concatenated without their own starts; discarded attempts count in
  /// `iterations` only. Normals have the sign of the result's plane.
  std::vector<SolverStep> trace = {};
};

/// Prepends the trace of `before` to `next`, which starts where `before` ends, and takes its
/// initial cost.
void continue_trace(const SolverReport& before, SolverReport& next);

/// Why a decomposition of a homography was rejected.
enum class Rejection {
  none,           ///< accepted
  behind_camera,  ///< points behind a camera
  rotation,       ///< rotation or score worse than the twin's
  normal,         ///< normal far from the density peak
  pair            ///< unsuitable pair of frames
};

/// One decomposition of a frame's homography.
struct HomographyCandidate {
  int frame;  ///< index in the window; the homography maps frame 0 to it
  HomographyMotion motion;
  double score;  ///< angle between R_21 and the given rotation; less is better [deg]
  Rejection rejection = Rejection::none;
  std::string rejected = {};  ///< reason for rejection with numbers, for people; empty if accepted
  int behind = 0;             ///< inliers behind a camera
  int of = 0;                 ///< inliers

  bool taken() const { return rejection == Rejection::none; }
  void reject(Rejection why, std::string in_words) {
    rejection = why;
    rejected = std::move(in_words);
  }
};

/// Estimate of one of the window's planes.
struct PlaneEstimate {
  int number = 0;                                         ///< index in the window
  Plane plane;                                            ///< [distance of the main plane]
  std::optional<Eigen::Matrix3d> normal_covariance = {};  ///< [rad^2], rank 2
  std::optional<double> distance_sigma = {};
};

/// A solution that was rejected, kept for display.
struct RefusedSolution {
  Plane plane;
  std::vector<Pose> cameras;  ///< one per frame
};

/// How a window ended whose homographies fit two orientations of the plane equally well. The method
/// was run with the rotations of both.
struct Ambiguity {
  double apart_deg = 0;  ///< angle between the orientations, before the optimization
  /// Solutions between which the tracks do not decide, the returned one first; empty if they do.
  std::vector<RefusedSolution> undecided = {};
  /// The solution that the tracks decide against most weakly; nullopt if all are one.
  struct Rejected {
    double apart_deg = 0;  ///< angle between its normal and the result's
    double sigmas = 0;     ///< by which the tracks fit the result better
  };
  std::optional<Rejected> rejected = std::nullopt;
  std::string failure = {};  ///< why the method failed from one orientation; empty if it did not
};

/// Result of a method. World = reference camera, gauge: plane distance 1. If `ok` is false,
/// `reason` says why, and there are no poses, points or plane.
struct Initialization {
  bool ok = false;
  bool stopped = false;  ///< cancelled by its `Watch`
  std::string reason;
  Plane plane;                        ///< the main plane
  std::vector<PlaneEstimate> planes;  ///< if inliers are chosen by planes; the main plane first
  std::vector<Pose> cameras;          ///< one per frame
  std::vector<MapPoint> points;       ///< inlier tracks; without a plane all tracks used
  std::vector<int> dropped = {};      ///< inlier tracks beyond the plane's horizon, columns
  SolverReport solver;
  double rms_px = 0;  ///< root mean square of the method's own errors over the observations used
  /// Root mean squares over the inliers of the main plane, the same two for every method: of the
  /// distances to the positions of the reference frame transferred by plane and cameras, without
  /// the reference frame; and to the projected map points. nullopt if unknown.
  std::optional<double> transfer_rms_px = {};
  std::optional<double> reprojection_rms_px = {};
  std::optional<Eigen::Vector3d> bias_rad_s;  ///< gyroscope bias, if the method estimates it
  std::optional<double> time_offset_s;  ///< gyroscope clock = camera clock + offset, if estimated
  /// `time_offset_s` minus the offset with which the window's rotations were integrated.
  std::optional<double> time_offset_correction_s = {};
  std::optional<double> row_delay_s;               ///< between two rows of an image, if estimated
  std::optional<LensResidual> lens_residual = {};  ///< if estimated; the points have it
  /// Covariances of the method's own estimates, from runs without each region of the image; nullopt
  /// if not computed.
  std::optional<NoiseSpread> own_noise;
  std::optional<Uncertainty> uncertainty;  ///< if ok and determined
  std::optional<Verdict> verdict;          ///< also for rejected windows
  /// All decompositions of methods that decompose homographies, also after a failure.
  std::vector<HomographyCandidate> candidates;
  /// The rejected solution of a failure.
  std::optional<RefusedSolution> refused = {};
  /// Another minimum of the method's cost, about as low, if it looked for one.
  std::optional<RefusedSolution> other_minimum = {};
  std::optional<Ambiguity> ambiguity = {};  ///< nullopt if the rotations were clear
};

/// Copies the planes' uncertainties from `uncertainty` to `planes`.
void set_plane_uncertainties(Initialization& result);

Initialization failed(std::string reason, SolverReport solver = {});
/// Turns a result into a failure that keeps the solution in `refused`.
Initialization refused(std::string reason, Initialization found);
/// Returns the failure of a solver that did not converge.
Initialization not_converged(SolverReport solver);
/// Returns the failure of a method that its `Watch` cancelled.
Initialization stopped_early();

}  // namespace gpo
