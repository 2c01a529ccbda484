// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/inspection/settings/settings.h"
#include "engine/inspection/window/progress.h"
#include "engine/recording/recording.h"

#include <memory>
#include <stop_token>

namespace gpo {

struct Stages;

/// Computes inspections; keeps each stage (tracks, truth, inliers, rotations) until its own inputs
/// change, and of the windows from one start the tracks and the truth of the longest, which begin
/// with those of the shorter ones. One thread at a time.
class Inspector {
 public:
  explicit Inspector(std::shared_ptr<const Recording> recording);
  ~Inspector();
  /// The whole chain. Null where it was stopped (within 50 ms). Throws InputError, e.g. for a
  /// window that does not fit or an unknown method.
  std::shared_ptr<const Inspection> inspect(const Settings& settings,
                                            const std::stop_token& stop = {},
                                            const Progress& progress = {});

 private:
  std::unique_ptr<Stages> stages_;
};

}  // namespace gpo
