// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/images/images.h"
#include "ui/workbench/work/worker.h"

#include <functional>
#include <vector>

namespace gpo {

/// Draws a view of a state without controls, CV_8UC3, BGR.
using DrawState =
    std::function<cv::Mat(const WorkbenchState& shown, const std::string& view, cv::Size size)>;

/// Returns the progress of the inspections that a report waits for.
JobStatus report_status(const WorkbenchState& state);

/// Removes the screenshots that can be written now from the requests, and returns them: reports
/// wait until everything that they show is computed.
std::vector<Screenshot> take_screenshots(WorkbenchState& state, const WorkerLink& link);

/// Writes the report of the current result, with the compared results and the curves as far as they
/// are computed. Throws InputError without a result, and if the file cannot be written.
void write_window_report(const WorkbenchState& state, const fs::path& file, const DrawState& draw);

/// Writes the window's frames into a movie, one a step: the image, or the compared columns.
class Movie {
 public:
  /// Copies the state: later changes do not affect it. Throws InputError if the file is unwritable.
  Movie(const MovieRequest& request, const WorkbenchState& state);

  /// Draws and writes the next frame; the last one completes the file. Throws InputError.
  void step(const DrawState& draw);

  int done() const { return done_; }
  int of() const { return frames_; }
  bool finished() const { return done_ == frames_; }
  const fs::path& file() const { return video_.file(); }

 private:
  WorkbenchState state_;
  std::string view_;
  cv::Size size_;
  int first_, frames_, done_ = 0;
  VideoEncoder video_;
};

}  // namespace gpo
