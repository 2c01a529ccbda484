// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspector.h"
#include "engine/methods/initializers.h"
#include "engine/methods/plane/normal_landscape.h"

namespace gpo {

/// Returns the estimated planes, the main plane first, also if inliers were not chosen by planes.
/// Their covariances contain a typical lens (`add_typical_lens`).
std::vector<PlaneEstimate> found_planes(const Inspection& inspection);

/// Name of a plane by its orientation to gravity.
struct PlaneName {
  /// floor: level, below the cameras, and the lowest such plane of the window; table: level, above
  /// the floor; ceiling: level, above the cameras; wall: upright; slanted.
  std::string name;
  double tilt_deg = 0;  ///< angle of its normal (towards the cameras) from up: 0 floor, 90 wall
  /// Uncertainty of the tilt (1 sigma), from the normal and from gravity; nullopt: the method gives
  /// none for this plane.
  std::optional<double> sigma_deg = std::nullopt;
};

/// Returns the name of a plane by its number in the window; nullopt if gravity or the plane is
/// unknown or less certain than 15 deg.
std::optional<PlaneName> plane_name(const Inspection& inspection, int number);

/// Returns "plane 2 (wall)", or "plane 2" without a name.
std::string plane_title(const Inspection& inspection, int number);

/// Returns the color of a plane and its inliers, 0xRRGGBB, in views and exports. It does not depend
/// on which plane leads: planes are numbered by their support. No verdict has the color of a plane
/// but the first.
std::uint32_t plane_color(int number);

/// Extent of a plane other than the leading one, in the estimate's world.
struct PlanePatch {
  int number = 0;  ///< plane number in the window
  Eigen::Vector3d normal;
  std::array<Eigen::Vector3d, 4> corners = {};
  std::vector<MapPoint> points;
};

/// Returns the patches of all further planes of a successful initialization.
std::vector<PlanePatch> plane_patches(const Inspection& inspection);

/// Returns the patches of the refused solutions' planes; without those that none of the tracks
/// meets.
std::vector<PlanePatch> refused_patches(const Inspection& inspection);

/// Evidence of a window on the plane's normal, independent of the method. Immutable.
struct NormalStudy {
  std::shared_ptr<const Window> window;
  NormalLandscape landscape;
  std::vector<std::vector<HomographyCandidate>> candidates;  ///< one per frame of the window
  std::vector<NormalCluster> clusters;                       ///< over the whole window's candidates
  std::string error = {};  ///< why it failed, one line; then only `window` is set
};

/// Returns the study; null if stopped. Throws InputError for bad input.
std::shared_ptr<const NormalStudy> study_normals(const Inspection& inspection,
                                                 const std::stop_token& stop = {});

/// Returns the true normal in the reference camera, towards it; nullopt if unknown.
std::optional<Eigen::Vector3d> true_normal(const Inspection& inspection);

/// Observation of a track, and its prediction from its plane, the poses and the reference frame.
struct ResidualVector {
  int track;
  int plane;                                  ///< number
  Eigen::Vector2d observed_px, predicted_px;  ///< raw
};

/// Returns the residuals of all planes' inliers in a frame of the window; empty if the
/// initialization failed.
std::vector<ResidualVector> residual_vectors(const Inspection& inspection, int frame_in_window);

/// Returns the lengths of the main plane's inliers' residuals in a frame of the window [raw px]:
/// from the observation to the result's prediction from the reference frame. Empty if the
/// initialization failed.
std::vector<double> residuals_px(const Inspection& inspection, int frame_in_window);

struct TrackFrame {
  int frame = 0;           ///< in the recording
  Eigen::Vector2d raw_px;  ///< observation
  /// Transfer error by the frame's homography of the track's plane, or of the leading plane if it
  /// is on none, undistorted [px]; nullopt in the reference frame or without a homography. It
  /// decides whether the track is an inlier.
  std::optional<double> transfer_px = {};
  /// Largest `transfer_px` of an inlier in this frame: the threshold, widened for noisy tracks and
  /// narrowed for consistent ones. nullopt if there is none: without RANSAC, and for a track on no
  /// plane, which was judged over the window.
  std::optional<double> limit_px = {};
  /// Residual of the solution: against the track's plane, or the main plane if it is on none, and
  /// the poses of the result [raw px]; nullopt without a prediction. It decides nothing.
  std::optional<double> residual_px = {};
  std::optional<double> forward_backward_px = {};  ///< nullopt if not measured
  bool inlier = false;                             ///< the track is an inlier of the leading plane
  bool on_its_plane = false;                       ///< the same for the plane that the track is on

  bool beyond_limit() const { return transfer_px && limit_px && *transfer_px > *limit_px; }
};

/// Returns what decided in a frame, and the residual, which did not: "transfer error 1.29 px of at
/// most 2 px: inlier; residual of the solution 4.12 px". Empty if neither is known.
std::string decision_text(const TrackFrame& seen);

/// History of a track of a window.
struct TrackLife {
  std::int64_t id = 0;
  int column = 0;                                 ///< column of the window's matrices
  std::vector<TrackFrame> frames;                 ///< frames that see it
  std::optional<double> depth;                    ///< in the reference camera, on its plane [d]
  std::optional<int> inlier_since, inlier_until;  ///< in the recording, the reference frame aside
  std::string verdict;                            ///< one sentence for people
};

/// Returns the history of a column of the window; for an excluded track as it was observed.
TrackLife track_life(const Inspection& inspection, int column);

/// Returns the histories of all columns of the window.
std::vector<TrackLife> track_lives(const Inspection& inspection);

/// Returns the RMS of the residuals in the frames where the track is an inlier of its plane;
/// nullopt without any.
std::optional<double> rms_residual_px(const TrackLife& life);

/// Returns every track of a window in every frame that sees it, as a table that `read_tracks` can
/// read: `frame,track,x,y` in raw pixels, the number of its plane (empty: none), inlier or outlier,
/// the residual [raw px] (empty: none) and why it is an outlier or lost.
std::string tracks_csv(const Inspection& inspection);

/// Result of an initialization from one frame.
struct ScannedStart {
  int start = 0;    ///< reference frame, counts in the recording
  bool ok = false;  ///< there is a result
  Readiness readiness = Readiness::degenerate;
  std::optional<double> sigma_deg = {};  ///< uncertainty of the normal (1 sigma)
  std::optional<double> pne_deg = {};    ///< error of the normal; nullopt without truth
  std::string reason = {};               ///< cause of the failure, else of the verdict; one line
};

/// Returns "12 (ready, normal +- 0.2 deg, PNE 0.1 deg)", without unknown values.
std::string to_text(const ScannedStart& start);

/// Returns the start to initialize from: the best readiness, then the lowest uncertainty; null if
/// none has a result.
const ScannedStart* best_start(std::span<const ScannedStart> starts);

/// Returns the step that scans a recording with about a hundred windows.
int scan_step(int recorded_frames, int window_frames);

/// Returns starts `step` frames apart whose window fits, coarse to fine: the first ones cover the
/// whole recording.
std::vector<int> starts_to_scan(int recorded_frames, int window_frames, int step);

struct ScanOptions {
  std::span<const int> starts;
  int jobs = 1;  ///< threads
  std::stop_token stop = {};
};

/// Inspects a window from each start, with the given settings otherwise. Calls `found` from one
/// thread at a time, in any order. Returns when all are done, or soon after it was stopped. A start
/// that cannot be inspected has a reason.
void scan_starts(const std::shared_ptr<const Recording>& recording,
                 const Settings& settings,
                 const ScanOptions& options,
                 const std::function<void(ScannedStart)>& found);

/// Returns a table "start,time_s,status,verdict,sigma_deg,pne_deg,reason"; unknown cells are empty.
std::string to_csv(std::span<const ScannedStart> starts, const Recording& recording);

/// The scanned starts of a recording so far. Immutable.
struct StartScan {
  Settings settings;                 ///< start 0
  int step = 1;                      ///< frames from one start to the next
  int of = 0;                        ///< number of starts
  std::vector<ScannedStart> starts;  ///< the finished ones, by frame

  bool finished() const { return static_cast<int>(starts.size()) == of; }
};

/// Estimates rotations of at most `most_windows` windows of about 0.3 s, spread over the recording,
/// from the images alone. Uses five-point rotations if the scene is more than a plane, else those
/// of the default method's cameras or its start, or those that explain the homographies if the
/// camera only rotates. Skips windows without rotations. Calls `progress(done, of)` after each.
/// Throws InputError if there are no tracks.
std::vector<ImageRotations> rotations_over_recording(
    const std::shared_ptr<const Recording>& recording,
    int most_windows = 80,
    const std::function<void(int, int)>& progress = {},
    const std::stop_token& stop = {});

/// A camera after the window, located by PnP from the points of the window's planes.
struct ExtrapolatedCamera {
  int frame = 0;  ///< counts in the recording
  std::int64_t timestamp_ns = 0;
  Pose pose;             ///< in the estimate's world
  int points = 0;        ///< points of the planes that agree within the window's threshold
  double median_px = 0;  ///< median reprojection error of the points seen in the frame
};

/// Cameras of the frames right after a window. The window's result does not depend on them. They
/// have no uncertainty, because planes and points are held as they were estimated. Immutable.
struct Extrapolation {
  std::shared_ptr<const Inspection> inspection;  ///< the window
  std::vector<ExtrapolatedCamera> cameras = {};  ///< consecutive frames after it
  std::string end = {};  ///< why there are no more cameras, one line; empty if none were requested
  /// The inspection as if its window had these frames, too, for views: tracks, inliers, cameras and
  /// truth; `Inspection::extrapolated_from` is set. Null without cameras.
  std::shared_ptr<const Inspection> extended = {};

  int last_frame() const { return cameras.empty() ? -1 : cameras.back().frame; }
};

/// Locates the cameras of up to `frames` frames after a window that is ok, as long as at least
/// eight points of its planes are seen. The tracks are the recording's own, else
/// those of the built-in front end, followed on from the window. Returns null if stopped.
std::shared_ptr<const Extrapolation> extrapolate(
    const std::shared_ptr<const Inspection>& inspection,
    int frames,
    const std::stop_token& stop = {},
    const Progress& progress = {});

}  // namespace gpo
