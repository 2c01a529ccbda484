// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/recording/recording.h"

namespace gpo::test {

inline const Board kBoard{9, 6, 0.025};

inline Camera phone() {
  return {640, 480, 600, 604, 317, 243, Distortion::radial_tangential, {0.12, -0.25, 1e-3, -6e-4}};
}

}  // namespace gpo::test
