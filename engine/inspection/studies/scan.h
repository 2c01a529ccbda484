// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace gpo {

/// What an initialization from one frame comes to.
struct ScannedStart {
  int start = 0;    ///< reference frame, counts in the recording
  bool ok = false;  ///< there is a result
  Readiness readiness = Readiness::degenerate;
  std::optional<double> sigma_deg = {};  ///< standard deviation of the normal
  std::optional<double> pne_deg = {};    ///< its error, where truth is known
  std::string reason = {};               ///< the failure's, else the verdict's; one line
};

/// "12 (ready, normal +- 0.2 deg, PNE 0.1 deg)": the start and what it comes to, without what is
/// not known.
std::string to_text(const ScannedStart& start);

/// The one to initialize from: fit for more first, then by how sure the normal is. Null: none of
/// them has a result.
const ScannedStart* best_start(std::span<const ScannedStart> starts);

/// The step that scans a recording with about a hundred windows of so many frames.
int scan_step(int recorded_frames, int window_frames);

/// Starts `step` frames apart whose window fits, coarse to fine: the first ones lie all over the
/// recording.
std::vector<int> starts_to_scan(int recorded_frames, int window_frames, int step);

/// Inspects a window from each start, with these settings otherwise, on so many threads.
/// `found` is called by one thread at a time, in no order. Returns when all are done, or soon after
/// it was stopped. What cannot be inspected is a start with its reason.
void scan_starts(const std::shared_ptr<const Recording>& recording,
                 const Settings& settings,
                 std::span<const int> starts,
                 int jobs,
                 const std::stop_token& stop,
                 const std::function<void(ScannedStart)>& found);

/// "start,time_s,status,verdict,sigma_deg,pne_deg,reason", a line a start; unknown cells are empty.
std::string to_csv(std::span<const ScannedStart> starts, const Recording& recording);

/// The starts of a recording as far as they are scanned. Immutable.
struct StartScan {
  Settings settings;                 ///< start 0
  int step = 1;                      ///< frames from one start to the next
  int of = 0;                        ///< starts
  std::vector<ScannedStart> starts;  ///< those that are done, by frame

  bool finished() const { return static_cast<int>(starts.size()) == of; }
};

}  // namespace gpo
