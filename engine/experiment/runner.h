// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/experiment.h"
#include "engine/experiment/row.h"

#include <algorithm>

namespace gpo {

struct ExperimentProgress {
  int done = 0;      ///< windows, also those of earlier runs
  int of = 0;        ///< windows
  double share = 1;  ///< completed share of this run's work, 0 to 1
  int kept = 0;      ///< results of earlier runs, one per window and method
  int computed = 0;  ///< results of this run
};

struct RunOptions {
  int jobs = 1;  ///< starts that are computed at once
  /// The same for windows of `timed_length`. They come last, one length per start and each with
  /// newly decoded images, so that their times are comparable.
  int timing_jobs = 1;
  Shard shard = {};
  std::stop_token stop = {};
  std::function<void(const ExperimentProgress&)> progress = {};  ///< called by one thread at a time
  std::function<void(const std::string&)> note =
      {};  ///< called if an earlier run is redone or continued
};

/// Computes the results (one per window and method) that the folder does not have, or has from
/// other recordings, and saves each window when it is finished. Frees the images of finished
/// recordings. `recordings` are those of the experiment, in its order. Returns false if stopped; a
/// further call continues. The results do not depend on jobs and interruptions. A configuration
/// that does not apply to a recording gives a failed row with the reason. Throws InputError if a
/// file cannot be written.
bool run_experiment(const Experiment& experiment,
                    std::span<const std::shared_ptr<const Recording>> recordings,
                    const fs::path& folder,
                    const RunOptions& options);

/// Creates a folder with `experiment.json` and `windows/`, or reuses one whose plan this one
/// continues (`differences`); returns the names of differing recordings or programs,
/// whose windows will be redone. Throws InputError.
std::vector<std::string> begin_experiment(const fs::path& folder, const Experiment& experiment);

/// Throws InputError if the folder has files but no experiment.
void check_experiment_folder(const fs::path& folder);

Experiment read_experiment(const fs::path& folder, const MethodTable& methods = {});

void save_window(const fs::path& folder, const Experiment& experiment, std::span<const Row> rows);

struct WindowFile {
  /// One per configuration of the experiment; nullopt if missing, broken or different.
  std::vector<std::optional<Row>> rows;
  std::vector<std::string> differs;  ///< names of what another experiment has: "fx of desk"

  bool complete() const {
    return std::ranges::all_of(rows, [](const auto& row) { return row.has_value(); });
  }
};
WindowFile load_window(const fs::path& folder,
                       const Experiment& experiment,
                       const ExperimentTask& task,
                       int frames);

/// Rows in the order of the plan, each from the first folder that has it. Throws InputError.
std::vector<Row> collect_rows(const Experiment& experiment, std::span<const fs::path> folders);

Experiment merge_experiments(std::span<const fs::path> folders,
                             const fs::path& output,
                             const MethodTable& methods = {});

}  // namespace gpo
