// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/geometry/homography_decomposition.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/methods/common/uncertainty.h"
#include "engine/methods/common/verdict.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// How a solver ended.
enum class Termination { none, convergence, no_convergence, failure };

template <>
struct ChoiceKeys<Termination> {
  static constexpr const char* name = "termination";
  static constexpr std::array keys{"none", "convergence", "no_convergence", "failure"};
};

struct MapPoint {
  int track;                 ///< column in the window
  Eigen::Vector3d position;  ///< in the world, on or near the plane
};

/// The state that an iteration of a solver left behind.
struct SolverStep {
  double cost = 0;      ///< half the summed squares, as the solver weighs them [px^2]
  double gradient = 0;  ///< its largest component [px^2 per unit of the unknown]
  double step = 0;      ///< length of the step that led here, over all unknowns; 0: none was taken
  std::optional<Eigen::Vector3d> normal;  ///< of optimizations over a plane: the plane's
};

struct SolverReport {
  int iterations = 0;
  double initial_cost = 0;  ///< half the summed squares [px^2]
  double final_cost = 0;    ///< half the summed squares [px^2]
  int unknowns = 0;
  int residuals = 0;
  Termination termination = Termination::none;  ///< none: of methods that do not optimize
  double milliseconds = 0;
  /// The start, then one an iteration; empty of methods that do not optimize. An iteration whose
  /// step was refused repeats the state before it, with step 0. Ceres counts the start in
  /// `iterations` and leaves out a last step that changes no more than its tolerance. Rounds with
  /// other weights, a robust loss or fewer observations follow one another, their own starts left
  /// out; what was tried and not taken is counted in `iterations` only. Normals have the sign of
  /// the result's plane.
  std::vector<SolverStep> trace = {};
};

/// The rounds before and the next one, which starts where they end, as one trace: from the initial
/// cost of the first to the final cost of the last.
void continue_trace(const SolverReport& before, SolverReport& next);

/// Why a reading of a homography was not taken.
enum class Rejection {
  none,      ///< it was
  sight,     ///< it puts points behind a camera
  rotation,  ///< its rotation, or its score, is worse than its twin's
  normal,    ///< its normal is far from where all others gather
  pair       ///< the pair of frames that it is of will not do
};

/// One reading of a frame's homography, kept for people to look at.
struct HomographyCandidate {
  int frame;  ///< of the window; the homography is from frame 0 to it
  HomographyMotion motion;
  double score;  ///< angle between R_21 and the window's given rotation; less is better [deg]
  Rejection rejection = Rejection::none;
  std::string rejected = {};  ///< why it was not taken, for people, with numbers; empty: it was
  int behind = 0;             ///< inliers that it puts behind a camera
  int of = 0;                 ///< inliers

  bool taken() const { return rejection == Rejection::none; }
  void reject(Rejection why, std::string in_words) {
    rejection = why;
    rejected = std::move(in_words);
  }
};

/// One of the window's planes as it was found.
struct PlaneEstimate {
  int number = 0;                                         ///< in the window
  Plane plane;                                            ///< unit: distance of the leading plane
  std::optional<Eigen::Matrix3d> normal_covariance = {};  ///< [rad^2], rank 2
  std::optional<double> distance_sigma = {};              ///< of its distance
};

/// What a method had found when it was refused, for people to look at.
struct RefusedSolution {
  Plane plane;
  std::vector<Pose> cameras;  ///< one a frame
};

/// What every method delivers. World = reference camera, gauge: plane distance 1. Where `ok` is
/// false, `reason` says why and no poses, points or plane are delivered.
struct Initialization {
  bool ok = false;
  bool stopped = false;  ///< by its watch: a failure that says nothing of the window
  std::string reason;
  Plane plane;                        ///< the leading one
  std::vector<PlaneEstimate> planes;  ///< of a window that is told by planes; the leading one first
  std::vector<Pose> cameras;          ///< one a frame
  std::vector<MapPoint> points;   ///< inlier tracks; all that it used of a method without a plane
  std::vector<int> dropped = {};  ///< inlier tracks beyond the plane's horizon, columns
  SolverReport solver;
  double rms_px = 0;  ///< root mean square reprojection error over the observations used
  std::optional<Eigen::Vector3d> bias_rad_s;  ///< of the gyroscope, where the method estimates it
  std::optional<double> time_offset_s;        ///< gyroscope clock = camera clock + offset, likewise
  std::optional<double> row_delay_s;          ///< from one row of a picture to the next, likewise
  std::optional<Uncertainty> uncertainty;     ///< of a result that is ok, where it is determined
  std::optional<Verdict> verdict;             ///< also of a window that was refused
  /// Of methods that decompose homographies: all readings, also where the method failed.
  std::vector<HomographyCandidate> candidates;
  /// Of a failure of a method that came to a solution.
  std::optional<RefusedSolution> refused = {};
};

/// Puts what the uncertainty says of the planes beside each of them.
void set_planes_uncertainty(Initialization& result);

Initialization failed(std::string reason, SolverReport solver = {});
/// Of a solution that is not to be believed: what was found is kept in `refused`.
Initialization refused(std::string reason, Initialization found);
/// Of a solver that did not converge.
Initialization not_converged(SolverReport solver);
/// Of a method that its watch stopped.
Initialization stopped_early();

}  // namespace gpo
