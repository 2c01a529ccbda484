// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"

#include <functional>

namespace gpo {

/// View of a `Screenshot` that is written as an HTML report.
inline constexpr const char* kReportView = "report";

/// Draws a view of a state without controls, CV_8UC3, BGR.
using DrawState =
    std::function<cv::Mat(const WorkbenchState& shown, const std::string& view, cv::Size size)>;

/// Writes the report of the current result, with the compared results that are computed. Throws
/// InputError without a result, and if the file cannot be written.
void write_window_report(const WorkbenchState& state, const fs::path& file, const DrawState& draw);

}  // namespace gpo
