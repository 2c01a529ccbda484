// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/initialize.h"
#include "tests/engine/simulated_window.h"

#include <vector>

namespace gpo {
struct Inspection;
}

namespace gpo::test {

/// Returns the tracks of a window as a front end without distortion would provide them.
std::vector<Frame> frames_of(const Window& window);
/// Returns the tracks of an inspection as a user's front end would provide them.
std::vector<Frame> frames_of(const Inspection& inspection);
/// Returns the window's camera, which is exact.
Camera camera_of(const Window& window);

/// Fails if any bit of the cameras, planes, points, uncertainty or verdict differs.
void expect_same(const Initialization& one, const Initialization& other);

}  // namespace gpo::test
