// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/experiment.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>

namespace gpo {

struct ExperimentProgress {
  int done = 0;      ///< windows, those of earlier runs too
  int of = 0;        ///< windows
  double share = 1;  ///< done of the work of this run, 0 to 1
};

struct RunOptions {
  int jobs = 1;  ///< windows of so many starts are computed at once [-]
  Shard shard = {};
  std::stop_token stop = {};
  std::function<void(const ExperimentProgress&)> progress = {};  ///< called by one thread at a time
};

/// Computes the windows that the folder lacks and saves each when it is finished. `recordings` are
/// those of the experiment, in its order. False where it was stopped; called again it goes on. The
/// same results whatever the jobs and however often it was interrupted. What a configuration cannot
/// be tried on is a failed row with the reason. Throws InputError where a file cannot be written.
bool run_experiment(const Experiment& experiment,
                    std::span<const std::shared_ptr<const Recording>> recordings,
                    const std::filesystem::path& folder,
                    const RunOptions& options);

}  // namespace gpo
