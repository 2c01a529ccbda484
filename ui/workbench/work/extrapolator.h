// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/studies/studies.h"
#include "ui/workbench/work/task_queue.h"

#include <functional>

namespace gpo {

struct WorkbenchState;

/// Locates cameras after a window in the background. Thread-safe.
class Extrapolator {
 public:
  /// `changed` is called on the job's thread after a result.
  explicit Extrapolator(std::function<void()> changed = {});

  /// Requests the cameras after a window up to a frame of the recording; null: none. A result that
  /// reaches the frame or ends before it is kept. Otherwise twice as many frames are located,
  /// because the front end follows its tracks from the start of the window again.
  void want(const std::shared_ptr<const Inspection>& inspection, int frame);

  JobStatus status() const { return locked_status(job_); }
  /// For the requested inspection; null: none.
  std::shared_ptr<const Extrapolation> latest() const { return locked(job_, latest_); }

 private:
  BackgroundJob::Job next();

  std::shared_ptr<const Inspection> wanted_;  ///< null: none
  int frames_ = 0;                            ///< after the window; 0: none are requested
  std::shared_ptr<const Extrapolation> latest_;
  BackgroundJob job_;
};

/// Requests the cameras after the current window if the current frame is there, takes over those
/// that are known, and returns the progress. `published` is the window before its cubes were moved;
/// null: none is requested.
JobStatus follow_window(WorkbenchState& state,
                        const std::shared_ptr<const Inspection>& published,
                        Extrapolator& extrapolator);

}  // namespace gpo
