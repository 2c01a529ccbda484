// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/window.h"
#include "engine/initializers/initialization.h"
#include "engine/initializers/watch.h"

namespace gpo {

/// Plane bundle adjustment with the normal held as `initialize_dbscan` found it (the paper's FPBA).
Initialization initialize_fpba(const Window& window, const Watch& watch);

}  // namespace gpo
