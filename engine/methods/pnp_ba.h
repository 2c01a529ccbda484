// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/watch.h"
#include "engine/window/window.h"

namespace gpo {

/// Bundle adjustment started from `initialize_pnp` (the paper's "BA with PnP", the vision part of
/// VINS' start).
Initialization initialize_pnp_ba(const Window& window, const Watch& watch);

}  // namespace gpo
