// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/bundle/plane_adjustment.h"
#include "engine/methods/common/initialization.h"
#include "engine/methods/common/watch.h"
#include "engine/window/window.h"

namespace gpo {

/// Bundle adjustment of the inliers with all points on one plane, which moves unless its normal is
/// held; started from the poses and the plane of `start`.
Initialization refine_on_plane(const Window& window,
                               const Initialization& start,
                               PlaneNormal normal,
                               const Watch& watch);

/// The adjustment with a free normal, started from `initialize_dbscan` (the paper's PBA).
Initialization initialize_pba(const Window& window, const Watch& watch);

}  // namespace gpo
