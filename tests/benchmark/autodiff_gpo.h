// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/window/window.h"

namespace gpo::bench {

/// GPO as one writes it down first: a Ceres program of one automatically differentiated block a
/// point and frame over the normal's quaternion and the frame's tau (paper, eq. 8), dogleg with the
/// translations eliminated, from rest. What our own solver is held against.
Initialization initialize_autodiff_gpo(const Window& window);

}  // namespace gpo::bench
