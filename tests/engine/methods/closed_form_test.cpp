// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/initializers.h"
#include "engine/methods/plane/linear_solutions.h"
#include "tests/engine/simulated_window.h"

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

/// Returns the length of a path that stays in front of the plane.
double longest_travel(Motion motion) {
  const bool along = motion == Motion::sideways || motion == Motion::up_down;
  return along || motion == Motion::wander ? 1.2 : 0.6;
}

TEST(ClosedForm, IsExactWithoutNoise) {
  for (const Motion motion : kMotions) {
    for (const double travel : {0.04, 0.3, longest_travel(motion)}) {
      const Simulation truth =
          simulate({.motion = motion, .noise_px = 0, .travel = travel, .tilt_deg = 20, .seed = 3});
      const auto found = closed_form_motion(truth.window);
      ASSERT_TRUE(found);
      EXPECT_LT(angle_deg(found->normal, truth.plane.normal), 1e-4);
      for (std::size_t i = 0; i < found->tau.size(); ++i)
        EXPECT_LT((found->tau[i] + truth.cameras[i].p_wc).norm(), 1e-6);
    }
  }
}

TEST(ClosedForm, IgnoresScaleAndSignOfHomographies) {
  Simulation truth = simulate({.noise_px = 0});
  for (std::size_t i = 0; i < truth.window.H_i1.size(); ++i)
    truth.window.H_i1[i] *= i % 2 == 0 ? -3.0 : 0.2;
  EXPECT_LT(angle_deg(closed_form_motion(truth.window)->normal, truth.plane.normal), 1e-4);
}

TEST(ClosedForm, GivesGpoAStartThatConverges) {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const Motion motion = kMotions[seed % std::size(kMotions)];
    const double travels[] = {0.04, 0.3, longest_travel(motion)};
    const Simulation truth =
        with_fitted_homographies(simulate({.motion = motion,
                                           .travel = travels[seed % 3],
                                           .tilt_deg = 10.0 + static_cast<double>(seed % 30),
                                           .gyro_bias_rad_s = 0.002,
                                           .seed = seed}));
    const Initialization result = initialize_gpo(truth.window, {}, {});
    // Errors are a few degrees at low parallax, tens of degrees for the wrong twin.
    EXPECT_TRUE(result.ok) << result.reason << " " << seed;
    if (!result.ok) continue;
    EXPECT_LT(angle_deg(result.plane.normal, truth.plane.normal), 15) << seed;
  }
}

TEST(ClosedForm, RejectsMissingHomography) {
  Simulation truth = simulate({});
  truth.window.H_i1[4].setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(closed_form_motion(truth.window));
}

}  // namespace
}  // namespace gpo::test
