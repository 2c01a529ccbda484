// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/common/refined_start.h"

#include "engine/methods/common/window_checks.h"

#include <fmt/format.h>

namespace gpo {

Initialization refined_start(const Window& window,
                             const StartMethod& start,
                             Refinement refine,
                             const Watch& watch) {
  if (auto reason = reason_not_to_try(window)) return failed(*reason);
  Initialization started = start.initialize(window, watch);
  if (started.stopped) return started;
  Initialization result = started.ok
                              ? refine(window, started, watch)
                              : failed(fmt::format("start by {}: {}", start.title, started.reason));
  result.candidates = started.candidates;
  return result;
}

}  // namespace gpo
