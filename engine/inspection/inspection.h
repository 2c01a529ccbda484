// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/evaluation/evaluation.h"
#include "engine/inertial/inertial_alignment.h"
#include "engine/inspection/settings/settings_table.h"

#include <algorithm>

namespace gpo {

/// Place of the virtual cube (engine/method.md, "The virtual cube"). Base edges are along the
/// columns x and y of `axes`; z is the plane's normal, towards the camera; x cross y points away.
struct CubeAnchor {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< on the plane
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  bool on_board = false;  ///< origin is a base corner, on a chessboard; else the base's center
  double unit = 1;  ///< side of a chessboard square, else the plane's distance from the camera
};

/// Centers the base where a ray of the camera meets the plane; nullopt if it misses it.
std::optional<CubeAnchor> anchor_on_plane(const Plane& plane_w,
                                          const Pose& camera,
                                          const Eigen::Vector3d& ray_c);

/// First corner and axes on the plane along `corner_rays_c`; nullopt if a ray misses the plane.
std::optional<CubeAnchor> anchor_on_board(const Plane& plane_w,
                                          const Pose& camera,
                                          std::span<const Eigen::Vector3d> corner_rays_c,
                                          const Board& board);

double default_cube_side(const CubeAnchor& anchor, double plane_distance = 1);

/// Bit 0 of a corner's index is x, bit 1 y, bit 2 z (4..7: the top). A tower is several sides high.
std::array<Eigen::Vector3d, 8> cube_corners(const CubeAnchor& anchor,
                                            double side,
                                            double height_sides = 1);

/// On the board seen at these raw pixels (row by row), or on the ray to the inliers' centroid.
/// `reference` is the reference camera in the plane's world. nullopt if a ray misses the plane.
std::optional<CubeAnchor> place_cube(const Plane& plane_w,
                                     const Pose& reference,
                                     const Recording& recording,
                                     const Window& window,
                                     const std::vector<Eigen::Vector2d>& board_corners_raw_px);

/// Computation time of each stage [ms].
struct Timing {
  double track = 0, ransac = 0, rotations = 0, initialize = 0, optimize = 0, total = 0;
};

struct FrameMotion {
  /// Median motion of the inliers beyond the given rotation, undistorted [px]; NaN without inliers.
  double parallax_px = 0;
  /// Angular rate of the given rotations to the next frame (for the last one: from the one before).
  double rotation_rate_deg_s = 0;
};

std::vector<FrameMotion> frame_motion(const Window& window);

/// One finished inspection of a recording with some settings. Immutable; views share it.
struct Inspection {
  std::shared_ptr<const Recording> recording;
  Settings settings;
  RotationSource rotations_used = RotationSource::gyro;  ///< never automatic
  std::string rotations_note;                            ///< see `ChosenRotations::note`
  std::optional<Eigen::Vector3d> gyroscope_bias_rad_s;   ///< subtracted from the rates
  std::shared_ptr<const Tracks> tracks;
  std::shared_ptr<const Window> window;
  std::shared_ptr<const WindowTruth> truth;  ///< null if unknown
  std::shared_ptr<const Initialization> initialization;
  /// nullopt if the initialization failed, it is not requested, or there is no accelerometer.
  std::optional<InertialAlignment> inertial;
  /// Frame of the window from which on the metric scale is available; nullopt if it is not.
  std::optional<int> metric_scale_from;
  /// Verdicts of the windows of 2, 3, ... frames from the same start, as the window grows.
  std::vector<Verdict> growth;
  std::vector<FrameMotion> motion;       ///< one a frame of the window; empty without rotations
  std::optional<Evaluation> evaluation;  ///< nullopt if the initialization failed or without truth
  std::optional<CubeAnchor> cube;        ///< on the estimated plane; nullopt if it failed
  /// The same place on the true plane, in the truth's world, scaled by true_cube.unit / cube.unit.
  std::optional<CubeAnchor> true_cube;
  Timing timing;
};

/// Moves both cubes (of the default side) to where a ray of the reference camera meets the planes.
/// Leaves both if it misses the estimated plane; drops the true cube if it misses only that plane.
void move_cubes(Inspection& inspection, const Eigen::Vector3d& ray_c);

/// The normal's standard deviation with the verdict's lens [deg]: the result's, else the verdict's.
std::optional<double> normal_sigma_deg(const Inspection& inspection);

/// Returns what the inliers are counted from, for people: "tracks, consistent".
std::string inliers_note(const Inspection& inspection);

std::vector<TruthJump> truth_jumps(const Inspection& inspection);

/// Returns one line for each remark: a missing plane that was requested, a jump of the truth.
std::vector<std::string> notes_of(const Inspection& inspection);

struct Surveyed {
  Settings settings;
  std::shared_ptr<const Inspection> inspection;  ///< null if it failed
  std::string error;                             ///< why it failed, one line
};

using SurveyResults = std::vector<Surveyed>;

inline const Surveyed* find_surveyed(const SurveyResults* results, const Settings& settings) {
  if (results == nullptr) return nullptr;
  const auto found = std::ranges::find(*results, settings, &Surveyed::settings);
  return found == results->end() ? nullptr : &*found;
}

}  // namespace gpo
