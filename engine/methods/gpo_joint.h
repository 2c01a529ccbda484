// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/method_options.h"
#include "engine/methods/common/watch.h"
#include "engine/window/window.h"

namespace gpo {

/// Global plane optimization in which what is uncertain of the rotations is unknown, too: a
/// constant gyroscope bias (Gaussian prior), the gyroscope's integrated noise and, asked for, the
/// offset between the clocks; without a gyroscope the rotation of every frame. Starts from GPO with
/// the rotations as given, never from rest, and says so where it ends in a wrong minimum.
Initialization initialize_gpo_joint(const Window& window,
                                    const MethodOptions& options,
                                    const Watch& watch);

}  // namespace gpo
