// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/watch.h"
#include "engine/window/window.h"

#include <string>

namespace gpo {

/// The method whose result another one improves.
struct StartMethod {
  std::string title;  ///< for people
  Initialization (*initialize)(const Window& window, const Watch& watch);
};

/// Improves `start`, which is `ok`.
using Refinement = Initialization (*)(const Window& window,
                                      const Initialization& start,
                                      const Watch& watch);

/// The start refined; where there is none, why, and which start it was.
Initialization refined_start(const Window& window,
                             const StartMethod& start,
                             Refinement refine,
                             const Watch& watch);

}  // namespace gpo
