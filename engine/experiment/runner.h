// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/experiment.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>
#include <string>

namespace gpo {

struct ExperimentProgress {
  int done = 0;      ///< windows, those of earlier runs too
  int of = 0;        ///< windows
  double share = 1;  ///< done of the work of this run, 0 to 1
};

struct RunOptions {
  int jobs = 1;  ///< windows of so many starts are computed at once [-]
  /// The same for those of `timed_length`, which come last, one length a start and each with its
  /// pictures decoded anew, so that their times are comparable [-].
  int timing_jobs = 1;
  Shard shard = {};
  std::stop_token stop = {};
  std::function<void(const ExperimentProgress&)> progress = {};  ///< called by one thread at a time
  /// Called with a line for people where what an earlier run left is done again.
  std::function<void(const std::string&)> note = {};
};

/// Computes the windows that the folder lacks, or has of other recordings, and saves each when it
/// is finished; of a recording whose windows are done the decoded pictures are let go. `recordings`
/// are those of the experiment, in its order. False where it was stopped; called again it goes on.
/// The same results whatever the jobs and however often it was interrupted. What a configuration
/// cannot be tried on is a failed row with the reason. Throws InputError where a file cannot be
/// written.
bool run_experiment(const Experiment& experiment,
                    std::span<const std::shared_ptr<const Recording>> recordings,
                    const std::filesystem::path& folder,
                    const RunOptions& options);

}  // namespace gpo
