// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <stop_token>

namespace gpo {

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

}  // namespace gpo
