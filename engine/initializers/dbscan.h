// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/window.h"
#include "engine/initializers/initialization.h"
#include "engine/initializers/watch.h"

namespace gpo {

/// The paper's second baseline: decomposes the homography of every frame, clusters all possible
/// normals on the unit sphere by density (DBSCAN, Ester et al. 1996) and takes the normal where the
/// density peaks; translations by linear least squares given it. The window's rotations tell true
/// readings from false ones and are delivered as they are. Nothing is optimized.
Initialization initialize_dbscan(const Window& window, const Watch& watch);

}  // namespace gpo
