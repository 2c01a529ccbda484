// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/pipeline/pipeline.h"

#include <chrono>

namespace gpo {

using Progress = std::function<void(const std::string& stage, int done, int of)>;

double milliseconds_since(std::chrono::steady_clock::time_point begin);

struct Tracked {
  std::shared_ptr<const Tracks> tracks;
  std::vector<double> milliseconds;  ///< until each frame was done
};

Tracked chosen_tracks(const Recording& recording, const FrameSpan& span);

/// nullopt if stopped. Throws InputError for a recording without images.
std::optional<Tracked> followed_tracks(const Recording& recording,
                                       const FrameSpan& span,
                                       Tracking tracking,
                                       const std::stop_token& stop,
                                       const Progress& progress);

std::shared_ptr<const Tracks> beginning(const std::shared_ptr<const Tracks>& whole, int frames);

/// Returns the recording's truth, or that of the board in its images; null without either.
std::shared_ptr<const WindowTruth> window_truth(const Recording& recording,
                                                const FrameSpan& span,
                                                const std::stop_token& stop,
                                                const Progress& progress);

std::shared_ptr<const WindowTruth> beginning(const std::shared_ptr<const WindowTruth>& whole,
                                             int frames);

/// Corners in the reference image [raw px], hidden ones by the pose; empty without a board.
std::vector<Eigen::Vector2d> corners_in(const Recording& recording, int frame);

/// Returns the source that is tried first. Throws InputError if the recording lacks it.
RotationSource rotation_source_used(const Recording& recording, RotationSource requested);

/// Returns the sources that `automatic` may use: "gyro-calibrated", "five-point or averaging".
std::string automatic_rotations(const Recording& recording);

/// `truth` may be null if it is not the source. Throws InputError if a source is missing.
ChosenRotations window_rotations(const Recording& recording,
                                 const Window& window,
                                 const WindowTruth* truth,
                                 const InitializeOptions& options,
                                 const std::stop_token& stop);

/// Caches each stage until its inputs change; windows of one start share tracks. Not thread-safe.
class Inspector {
 public:
  explicit Inspector(std::shared_ptr<const Recording> recording);
  ~Inspector();
  /// null if stopped (within 50 ms). Throws InputError, e.g. for a window that does not fit.
  std::shared_ptr<const Inspection> inspect(const Settings& settings,
                                            const std::stop_token& stop = {},
                                            const Progress& progress = {});

 private:
  struct Stages;
  std::unique_ptr<Stages> stages_;
};

}  // namespace gpo
