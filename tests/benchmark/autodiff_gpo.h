// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/window/window.h"

namespace gpo::bench {

/// Returns GPO in its most direct implementation, the baseline for our solver: a Ceres problem with
/// an automatically differentiated block for each point and frame over the normal's quaternion and
/// the frame's tau (paper, eq. 8), solved by dogleg with eliminated translations, starting at zero
/// motion.
Initialization initialize_autodiff_gpo(const Window& window);

}  // namespace gpo::bench
