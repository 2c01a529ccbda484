// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/diagnosis/diagnosis.h"
#include "engine/evaluation/evaluation.h"
#include "engine/evaluation/truth_conventions.h"
#include "engine/inertial/inertial_alignment.h"
#include "engine/inspection/settings/settings_table.h"
#include "engine/methods/methods.h"

#include <algorithm>

namespace gpo {

/// Place of the virtual cube (engine/method.md, "The virtual cube"). Base edges are along the
/// columns x and y of `axes`, on the plane; column z is the plane's normal, towards the camera; x
/// cross y points away from the camera, as for rows and columns of an image.
struct CubeAnchor {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< on the plane
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  bool on_board = false;  ///< origin is a base corner, on a chessboard; else the base's center
  double unit = 1;  ///< side of a chessboard square, else the plane's distance from the camera
  std::optional<int> plane = std::nullopt;  ///< its number in the window; nullopt: the leading one

  bool operator==(const CubeAnchor&) const = default;
};

/// Centers the base where a ray of the camera meets the plane, with x as near as possible to the
/// camera's x. Returns nullopt if the ray misses the plane.
std::optional<CubeAnchor> anchor_on_plane(const Plane& plane_w,
                                          const Pose& camera,
                                          const Eigen::Vector3d& ray_c);

/// Projects the board's first corner and axes onto the plane along `corner_rays_c` (all corners,
/// row by row) of `camera`. Returns nullopt if a ray misses the plane.
std::optional<CubeAnchor> anchor_on_board(const Plane& plane_w,
                                          const Pose& camera,
                                          std::span<const Eigen::Vector3d> corner_rays_c,
                                          const Board& board);

/// Returns 0.2 of the plane's distance, or the nearest whole number of chessboard squares.
double default_cube_side(const CubeAnchor& anchor, double plane_distance = 1);

/// Returns the corners: bit 0 of the index is x, bit 1 is y, bit 2 is z (4..7 are the top). A tower
/// is several sides high.
std::array<Eigen::Vector3d, 8> cube_corners(const CubeAnchor& anchor,
                                            double side,
                                            double height_sides = 1);

/// Places the cube on a plane, in the plane's world: on the recording's board, seen in the
/// reference image at these raw pixels (row by row), or without a board where the ray to the
/// inliers' centroid meets the plane. `reference` is the reference camera in that world. Returns
/// nullopt if a ray misses the plane.
std::optional<CubeAnchor> place_cube(const Plane& plane_w,
                                     const Pose& reference,
                                     const Recording& recording,
                                     const Window& window,
                                     const std::vector<Eigen::Vector2d>& board_corners_raw_px);

struct Inspection;

/// Places a cube on each further plane with an estimate, where the reference camera sees the track
/// nearest to the center of its tracks: the plane may have a gap at the center.
std::vector<CubeAnchor> place_other_cubes(const Inspection& inspection);

/// Computation time of each stage [ms].
struct Timing {
  double track = 0, ransac = 0, rotations = 0, initialize = 0, optimize = 0, total = 0;
};

/// Motion of a frame of the window, before anything is initialized.
struct FrameMotion {
  /// Median motion of the inliers since the reference frame beyond the given rotation, undistorted;
  /// NaN without inliers [px].
  double parallax_px = 0;
  /// Angular rate of the given rotations to the next frame (for the last one: from the one before).
  double rotation_rate_deg_s = 0;
};

std::vector<FrameMotion> frame_motion(const Window& window);

/// Metric scale from the known distance of two points on planes of the window.
struct MeasuredScale {
  double meters_per_unit = 0;
  /// Standard deviation of its logarithm: by the stated length, 0.5 px for each coordinate of the
  /// points, and the planes and the camera, whose correlations are neglected. nullopt if the result
  /// has no uncertainty.
  std::optional<double> log_sigma = std::nullopt;
  std::string reason = {};  ///< why it is unknown, one line; empty if it is known
};

/// Axes of the user's world: the origin is a point on a plane, z is that plane's normal (towards
/// the camera) or up, and x points towards a second point.
struct ChosenWorld {
  Pose T_world_reference;   ///< [unit of the estimate]
  std::string reason = {};  ///< why it is unknown, one line; empty if it is known
};

/// One finished inspection: the chain of results for one recording and settings. Immutable; shared
/// with the views by shared_ptr<const>.
struct Inspection {
  std::shared_ptr<const Recording> recording;
  Settings settings;
  RotationSource rotations_used = RotationSource::gyro;  ///< never automatic
  std::string rotations_note;                            ///< see `ChosenRotations::note`
  std::optional<Eigen::Vector3d> gyroscope_bias_rad_s;   ///< subtracted from the rates
  std::shared_ptr<const Tracks> tracks;
  std::shared_ptr<const Window> window;
  /// `window` as it was when its inliers were selected, without the row delay that was compensated
  /// then (`at_time_stamps`); null if none was.
  std::shared_ptr<const Window> selection = nullptr;
  std::shared_ptr<const WindowTruth> truth;  ///< null if unknown
  /// Why the truth is not used for errors; nullopt if it is.
  std::optional<TruthConvention> truth_convention = {};
  std::shared_ptr<const Initialization> initialization;
  /// Evidence against inputs and result, the heaviest first; also what the ground truth shows.
  std::vector<Finding> findings = {};
  /// Motion of the estimated cameras around each frame; empty if no row delay is known.
  std::vector<RowMotion> row_motions = {};
  /// Gravity and metric scale; nullopt if the initialization failed, they are not requested, or the
  /// recording has no accelerometer.
  std::optional<InertialAlignment> inertial;
  /// Frame of the window from which on the metric scale is available; nullopt if it is not.
  std::optional<int> metric_scale_from;
  std::optional<MeasuredScale> measured_scale = {};  ///< nullopt if it is not requested
  std::optional<ImportedResult> imported = {};       ///< nullopt unless another program's result
  std::optional<ChosenWorld> chosen_world = {};      ///< nullopt if it is not requested
  /// Verdicts of the windows of 2, 3, ... frames from the same start, as the window grows, with the
  /// row delay and the motion between rows of the result.
  std::vector<Verdict> growth;
  /// The same by the criterion of the whole window: wider where its own uncertainty is wider than
  /// that of its growth, because only the former compares image regions. Empty without both.
  std::vector<Verdict> comparable_growth = {};
  std::vector<FrameMotion> motion;       ///< one per frame of the window; empty without rotations
  std::optional<Evaluation> evaluation;  ///< nullopt if the initialization failed or without truth
  std::optional<CubeAnchor> cube;        ///< on the estimated plane; nullopt if it failed
  std::vector<CubeAnchor> other_cubes = {};  ///< one on each further plane that has an estimate
  /// The same place on the true plane, in the truth's world; its side is that of `cube` times
  /// true_cube.unit / cube.unit.
  std::optional<CubeAnchor> true_cube;
  Timing timing;
  /// Frame of the window from which on cameras are extrapolated (`extrapolate`); nullopt: none are.
  std::optional<int> extrapolated_from = {};
};

/// Largest distance of a pixel from a track of the plane that it shows [image width].
inline constexpr double kNearPlane = 0.05;

/// Returns the plane that the track is an inlier of in the frame; nullopt for outliers.
std::optional<int> plane_of_track(const Window& window, int frame, int column);

/// Returns the number of the plane under a pixel, that of the nearest track within `kNearPlane`;
/// nullopt if none is so near. `frame` counts in the window.
std::optional<int> plane_near(const Inspection& inspection,
                              int frame,
                              const Eigen::Vector2d& raw_px);

/// Returns the estimate of a plane by its number; null if there is none.
const Plane* estimated_plane(const Inspection& inspection, int number);

/// Intersects a pixel's ray with a plane, in the reference camera's frame; nullopt if it misses.
std::optional<Eigen::Vector3d> point_on_plane(const Inspection& inspection,
                                              int frame,
                                              const Eigen::Vector2d& raw_px,
                                              const Plane& plane);

/// The source of a metric scale: two points, the unit of an imported result, or the accelerometer.
enum class ScaleSource { points, result, accelerometer };

template <>
struct ChoiceKeys<ScaleSource> : NamedKeys<"scale source", "points", "result", "accelerometer"> {};

/// Returns the source of the scale: two points if they are given, else the unit of an imported
/// metric result, else the accelerometer, even if it does not determine the scale.
ScaleSource scale_source(const Inspection& inspection);

/// Returns the standard deviation of the logarithm of a known scale; nullopt if it is unknown.
std::optional<double> scale_log_sigma(const Inspection& inspection);

/// Returns the meters per unit of the estimate by `scale_source`; nullopt if it does not determine
/// them.
std::optional<double> known_scale(const Inspection& inspection);
/// Returns the same; throws InputError with the reason if it is unknown.
double meters_per_unit(const Inspection& inspection);

/// Moves the base centers of both cubes (of the default side) to where a ray of the reference
/// camera meets their planes, without rotating them. Both are then at the same place of the scene:
/// the worlds coincide in the reference camera, while scale and rotation errors of a path alignment
/// would shift one. Leaves both unchanged if the ray misses the estimated plane; drops the true
/// cube if it misses only the true plane. `plane`: number in the window; the cube of another plane
/// than the leading one (nullopt) is moved alone.
void move_cubes(Inspection& inspection,
                const Eigen::Vector3d& ray_c,
                std::optional<int> plane = std::nullopt);

/// Returns the center of a cube's base if the cube has its default size.
Eigen::Vector3d base_center(const Inspection& inspection, const CubeAnchor& cube);

/// Returns the cubes of all planes that have one, the leading plane's first.
std::vector<CubeAnchor> all_cubes(const Inspection& inspection);

/// Returns the normal's standard deviation with the lens that the verdict assumes [deg]: that of
/// the result, else that of the verdict.
std::optional<double> normal_sigma_deg(const Inspection& inspection);

/// Returns the verdicts of a growing window for people.
inline const std::vector<Verdict>& shown_growth(const Inspection& inspection) {
  return inspection.comparable_growth.empty() ? inspection.growth : inspection.comparable_growth;
}

/// Returns whether the track of a column was excluded by hand, by its id or by a mask.
inline bool is_excluded(const Inspection& inspection, int column) {
  const Tracks& tracks = *inspection.tracks;
  const Settings& settings = inspection.settings;
  return std::ranges::binary_search(settings.exclude, tracks.ids[column]) ||
         settings.mask.contain(MaskKind::leave_out, tracks.raw_px[0].col(column));
}

/// Returns whether the track of a column does not move in the image (`Window::static_tracks`).
inline bool is_static(const Inspection& inspection, int column) {
  return std::ranges::binary_search(inspection.window->static_tracks, column);
}

/// Returns what the inliers are counted from, how many of these the last frame does not see, and
/// how the inliers were selected, for people: "tracks, 12 lost, consistent".
std::string inliers_note(const Inspection& inspection);

/// Returns the jumps of the ground truth within the window; empty without truth.
std::vector<TruthJump> truth_jumps(const Inspection& inspection);

/// Returns which readout time, estimated from its corners, the ground truth from a board has, or
/// that its poses are wrong because the tracks show a rolling shutter and the board does not
/// determine its readout time; empty if neither.
std::string board_truth_note(const Inspection& inspection);

/// Returns the texts of the findings that leave the verdict.
std::vector<std::string> notes_of(const Inspection& inspection);

/// Returns the evidence that a recording gives without a window. It must outlive the result.
Evidence evidence_of(const Recording& recording);

/// Adds the findings on the ground truth, on requested points and on settings without effect.
void add_findings(Inspection& inspection);

/// Result for one of many settings.
struct Surveyed {
  Settings settings;
  std::shared_ptr<const Inspection> inspection;  ///< null if it failed
  std::string error;                             ///< why it failed, one line
};

/// Results in the order of their computation. Immutable.
using SurveyResults = std::vector<Surveyed>;

/// Returns the result for the settings; null if there is none.
inline const Surveyed* find_surveyed(const SurveyResults* results, const Settings& settings) {
  if (results == nullptr) return nullptr;
  const auto found = std::ranges::find(*results, settings, &Surveyed::settings);
  return found == results->end() ? nullptr : &*found;
}

/// A result among those that a view shows.
struct ShownResult {
  std::string name;  ///< for people: "GPO without RANSAC"
  std::uint32_t rgb = 0;
  std::shared_ptr<const Inspection> inspection;
  bool current = false;  ///< the one that all views show
};

/// Returns the scale by `Settings::scale_points`; nullopt if none are given. The initialization is
/// ok.
std::optional<MeasuredScale> measure_scale(const Inspection& inspection);

/// Returns the axes by `Settings::world_points`; nullopt if none are given. The initialization is
/// ok.
std::optional<ChosenWorld> choose_world(const Inspection& inspection);

/// World and unit of exported poses, points and planes.
struct ExportWorld {
  Similarity T_world_reference;  ///< from the estimate's world, whose unit is the plane's distance
  std::string axes = "world = reference camera (x right, y down, z forward)";  ///< for people
  bool meters = false;

  std::string description() const {
    return axes + "; unit = " + (meters ? "meter" : "distance of the plane");
  }
};

/// Returns the chosen world, else that of the reference camera, in meters if `metric` is set or the
/// scale was measured. Throws InputError if a requested scale or world is unknown.
ExportWorld export_world(const Inspection& inspection, bool metric);

/// Throws InputError if points for the scale or the world were given but do not determine them.
void check_chosen(const Inspection& inspection);

}  // namespace gpo
