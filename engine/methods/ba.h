// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/watch.h"
#include "engine/window/window.h"

namespace gpo {

/// Bundle adjustment: minimizes the reprojection error over all poses and points,
/// started from `start`; of all tracks where the window says so, else of its inliers. The plane is
/// that of the adjusted inlier points, which are delivered as they are, on the plane or off it.
Initialization refine_bundle(const Window& window, const Initialization& start, const Watch& watch);

/// The adjustment started from `initialize_dbscan` (the paper's BA).
Initialization initialize_ba(const Window& window, const Watch& watch);

}  // namespace gpo
