// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/statistics.h"
#include "engine/methods/methods.h"
#include "engine/window/window.h"
#include "tests/engine/simulated_window.h"

#include <vector>

#include <gtest/gtest.h>

namespace gpo::test {

/// Median over seeds of the normal's error [deg], on default windows with homographies as fitted to
/// noisy tracks. A window that is refused is a failure of the test.
inline double median_normal_error_deg(Initialization (*initialize)(const Window&, const Watch&),
                                      Motion motion,
                                      std::uint64_t seeds) {
  std::vector<double> errors;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Simulation truth = with_fitted_homographies(simulate({.motion = motion, .seed = seed}));
    const Initialization result = initialize(truth.window, {});
    EXPECT_TRUE(result.ok) << result.reason;
    if (result.ok) errors.push_back(angle_deg(result.plane.normal, truth.plane.normal));
  }
  return median(std::move(errors));
}

}  // namespace gpo::test
