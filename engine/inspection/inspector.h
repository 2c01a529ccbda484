// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/inspection/settings/settings.h"
#include "engine/inspection/window/window_inputs.h"
#include "engine/recording/recording.h"

#include <memory>
#include <stop_token>

namespace gpo {

/// Computes inspections. Caches each stage (tracks, truth, inliers, rotations) until its own inputs
/// change. For windows from one start it caches tracks and truth of the longest, which begin with
/// those of the shorter ones. Not thread-safe.
class Inspector {
 public:
  explicit Inspector(std::shared_ptr<const Recording> recording);
  ~Inspector();
  /// Returns a finished inspection; null if stopped (within 50 ms). Throws InputError, e.g. for a
  /// window that does not fit or an unknown method.
  std::shared_ptr<const Inspection> inspect(const Settings& settings,
                                            const std::stop_token& stop = {},
                                            const Progress& progress = {});

 private:
  struct Stages;
  std::unique_ptr<Stages> stages_;
};

}  // namespace gpo
