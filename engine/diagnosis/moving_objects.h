// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/window/window.h"

#include <vector>

namespace gpo {

/// Returns the tracks of objects that move in the scene, columns of the window, ascending: groups
/// of neighbors that move alike, on no plane, and contradict the epipolar geometry of the result's
/// cameras. Objects that move along epipolar lines are not found. Empty if the result failed.
std::vector<int> moving_objects(const Window& window, const Initialization& result);

}  // namespace gpo
