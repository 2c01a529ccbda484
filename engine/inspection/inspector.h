// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/pipeline/pipeline.h"

#include <chrono>

namespace gpo {

enum class FrameFault;
struct RecordingFacts;

/// Called with a stage's name, the steps done and their number (0: unknown): "tracking 41/60".
using Progress = std::function<void(const std::string& stage, int done, int of)>;

double milliseconds_since(std::chrono::steady_clock::time_point begin);

/// Tracks of a window. They are made frame by frame, so a shorter window has their beginning.
struct Tracked {
  std::shared_ptr<const Tracks> tracks;
  std::vector<double> milliseconds;     ///< until each frame was done
  std::vector<FrameFault> faults = {};  ///< one per frame; empty for the recording's own tracks
};

/// Returns the recording's own tracks.
Tracked chosen_tracks(const Recording& recording, const FrameSpan& span);

/// Tracks by the built-in front end; nullopt if stopped. Throws InputError for a recording without
/// images.
std::optional<Tracked> followed_tracks(const Recording& recording,
                                       const FrameSpan& span,
                                       Tracking tracking,
                                       const std::stop_token& stop,
                                       const Progress& progress);

/// Returns the first frames of a longer window.
std::shared_ptr<const Tracks> beginning(const std::shared_ptr<const Tracks>& whole, int frames);

/// Returns the recording's own truth of a window, or that of the board in its images; null if there
/// is neither.
std::shared_ptr<const WindowTruth> window_truth(const Recording& recording,
                                                const FrameSpan& span,
                                                const std::stop_token& stop,
                                                const Progress& progress);

/// Returns the first frames of a longer window; null for null.
std::shared_ptr<const WindowTruth> beginning(const std::shared_ptr<const WindowTruth>& whole,
                                             int frames);

/// Returns the board's corners in the reference image [raw px], for the cube; hidden ones follow
/// from its pose. Empty if there is no board.
std::vector<Eigen::Vector2d> corners_in(const Recording& recording, int frame);

/// Returns the source that `automatic` or `raw` tries first; any other itself. Throws InputError if
/// the recording lacks it.
RotationSource rotation_source_used(const Recording& recording, RotationSource requested);

/// Returns the sources that `automatic` may use, for people: "gyro-calibrated", "five-point or
/// averaging".
std::string automatic_rotations(const Recording& recording);

/// Returns `window_rotations` of a recording's window. `truth` may be null if it is not the source.
/// Throws InputError if the recording lacks the source, or gyroscope or truth do not cover the
/// window.
WindowRotations window_rotations(const Recording& recording,
                                 const Window& window,
                                 const WindowTruth* truth,
                                 const InitializeOptions& options,
                                 const std::stop_token& stop);

/// Returns what results of other programs need. The clock reference has the true rotations, or else
/// those of the gyroscope as recorded; it is null without both.
RecordingFacts facts_for_results(const Recording& recording);

/// Computes inspections. Caches each stage (tracks, truth, inliers, rotations) until its own inputs
/// change. For windows from one start it caches tracks and truth of the longest, which begin with
/// those of the shorter ones. Not thread-safe.
class Inspector {
 public:
  explicit Inspector(std::shared_ptr<const Recording> recording);
  /// The same with the tracks that the built-in tracker would find in a window of the recording.
  Inspector(std::shared_ptr<const Recording> recording, std::shared_ptr<const Tracks> tracks);
  ~Inspector();
  /// Returns a finished inspection; null if stopped (within 50 ms). Throws InputError, e.g. for a
  /// window that does not fit or an unknown method.
  std::shared_ptr<const Inspection> inspect(const Settings& settings,
                                            const std::stop_token& stop = {},
                                            const Progress& progress = {});

 private:
  struct Stages;
  std::unique_ptr<Stages> new_stages(double intrinsics_scale) const;

  std::shared_ptr<const Recording> recording_;
  std::shared_ptr<const Tracks> tracks_;  ///< given ones; null: none
  std::unique_ptr<Stages> stages_;
};

}  // namespace gpo
