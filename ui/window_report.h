// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

}  // namespace gpo
