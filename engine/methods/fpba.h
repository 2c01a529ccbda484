// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/watch.h"
#include "engine/window/window.h"

namespace gpo {

/// Plane bundle adjustment with the normal held as `initialize_dbscan` found it (the paper's FPBA).
Initialization initialize_fpba(const Window& window, const Watch& watch);

}  // namespace gpo
