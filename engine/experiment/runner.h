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
  int done = 0;      ///< windows, also those of earlier runs
  int of = 0;        ///< windows
  double share = 1;  ///< completed share of this run's work, 0 to 1
};

struct RunOptions {
  int jobs = 1;  ///< starts that are computed at once
  /// The same for windows of `timed_length`. They come last, one length per start and each with
  /// newly decoded images, so that their times are comparable.
  int timing_jobs = 1;
  Shard shard = {};
  std::stop_token stop = {};
  std::function<void(const ExperimentProgress&)> progress = {};  ///< called by one thread at a time
  std::function<void(const std::string&)> note = {};  ///< called if an earlier run is redone
};

/// Computes the windows that the folder does not have, or has from other recordings, and saves each
/// when it is finished. Frees the images of finished recordings. `recordings` are those of the
/// experiment, in its order. Returns false if stopped; a further call continues. The results do not
/// depend on jobs and interruptions. A configuration that does not apply to a recording gives a
/// failed row with the reason. Throws InputError if a file cannot be written.
bool run_experiment(const Experiment& experiment,
                    std::span<const std::shared_ptr<const Recording>> recordings,
                    const std::filesystem::path& folder,
                    const RunOptions& options);

}  // namespace gpo
