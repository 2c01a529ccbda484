// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/window.h"
#include "engine/initializers/initialization.h"
#include "engine/initializers/watch.h"

namespace gpo {

/// Bundle adjustment started from `initialize_pnp` (the paper's "BA with PnP", the vision part of
/// VINS' start).
Initialization initialize_pnp_ba(const Window& window, const Watch& watch);

}  // namespace gpo
