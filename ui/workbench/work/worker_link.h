// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"
#include "ui/workbench/work/scan.h"
#include "ui/workbench/work/survey.h"
#include "ui/workbench/work/worker.h"

#include <filesystem>
#include <functional>
#include <memory>

namespace gpo {

/// Between the workbench and who computes for it: what was asked for, and how far it is.
struct WorkerLink {
  Settings requested;                           ///< last ones
  std::shared_ptr<const Inspection> published;  ///< before its cube was moved
  std::optional<Eigen::Vector3d> cube_ray;      ///< to where it was moved
  JobStatus worker;
  SurveyStatus survey;
  SurveyStatus scan;
  std::string error;              ///< the worker's last one that was said
  std::filesystem::path opening;  ///< what is being opened; remembered once it is open
  bool remembers_files = false;   ///< in the user's list of recent files
  bool calibrating = false;       ///< until there is a camera, a reason why not, or another request
  bool calibrates = false;        ///< whatever is opened with a guessed camera
  bool finding_start = false;     ///< until the scan has found one, or another request
  /// Called before a session is read: adds the methods that it names to the state's table. May
  /// throw InputError; null: none are added.
  std::function<void(const std::filesystem::path& session, WorkbenchState& state)> add_methods;
  bool survey_canceled = false;  ///< and the scan; until something else is computed

  bool busy() const { return worker.busy || survey.busy() || scan.busy(); }
};

/// Hands the state's new settings and requests (open, open_example, compute, calibrate, find_start,
/// cancel) to the worker, what the open views ask for to survey and scan, and takes over what they
/// have published. Returns at once. `example`: the recording that comes with the program.
void synchronize(WorkbenchState& state,
                 WorkerLink& link,
                 Worker& worker,
                 Survey& survey,
                 Scan& scan,
                 const std::filesystem::path& example);

}  // namespace gpo
