// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"
#include "ui/workbench/work/survey.h"
#include "ui/workbench/work/worker.h"

#include <filesystem>
#include <functional>
#include <memory>

namespace gpo {

/// The requests of the workbench to worker, survey and scan, and their progress.
struct WorkerLink {
  std::filesystem::path example;                ///< the recording shipped with the program
  Settings requested;                           ///< the last ones
  std::shared_ptr<const Inspection> published;  ///< before its cube was moved
  std::optional<Eigen::Vector3d> cube_ray;      ///< to which it was moved
  JobStatus worker;
  SurveyStatus survey;
  SurveyStatus scan;
  std::string error;              ///< the last error of the worker that was shown
  std::filesystem::path opening;  ///< being opened; remembered once it is open
  bool remembers_files = false;   ///< in the user's list of recent files
  bool calibrating = false;       ///< until it finishes, fails or is replaced
  bool calibrates = false;        ///< every recording opened with a guessed camera
  bool finding_start = false;     ///< until the scan has found one or is replaced
  bool survey_canceled = false;   ///< and the scan; until something else is computed
  /// Called before a session is read: adds its methods to the table of the state. May throw
  /// InputError; null: none are added.
  std::function<void(const std::filesystem::path& session, WorkbenchState& state)> add_methods;

  bool busy() const { return worker.busy || survey.busy() || scan.busy(); }
};

/// Passes new settings and requests (open, open_example, compute, calibrate, find_start, cancel) to
/// the worker and the needs of the open views to survey and scan, and takes over their results.
/// Returns at once.
void synchronize(
    WorkbenchState& state, WorkerLink& link, Worker& worker, Survey& survey, Scan& scan);

}  // namespace gpo
