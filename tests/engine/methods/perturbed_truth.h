// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "tests/engine/simulated_window.h"

#include <cstdint>

namespace gpo::test {

struct Perturbation {
  double rotation_deg = 0.5;  ///< standard deviation about each axis
  double position = 0.01;     ///< standard deviation of each coordinate [plane distance]
  double normal_deg = 2;      ///< tilt of the plane
  std::uint64_t seed = 1;
};

/// A start for an adjustment: the true poses and plane, perturbed; the reference camera is not.
Initialization perturbed_truth(const Simulation& truth, const Perturbation& perturbation = {});

}  // namespace gpo::test
