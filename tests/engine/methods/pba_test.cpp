// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/pba.h"

#include "engine/window/window.h"
#include "tests/engine/methods/perturbed_truth.h"
#include "tests/engine/simulated_window.h"

#include <cmath>

#include <gtest/gtest.h>

namespace gpo {
namespace {

using test::Motion;
using test::perturbed_truth;
using test::simulate;
using test::Simulation;

class PlaneAdjustmentOnMotion : public ::testing::TestWithParam<Motion> {};

TEST_P(PlaneAdjustmentOnMotion, RecoversNoiseFreeWindowsFromPerturbedStarts) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Simulation truth =
        simulate({.motion = GetParam(), .noise_px = 0, .off_plane = 0.2, .seed = seed});
    const Initialization start = perturbed_truth(truth, {.seed = seed});
    const Initialization result = refine_on_plane(truth.window, start, PlaneNormal::free, {});
    ASSERT_TRUE(result.ok) << result.reason;
    EXPECT_LT(angle_deg(result.plane.normal, truth.plane.normal), 1e-6);
    for (int i = 0; i < truth.window.frame_count(); ++i) {
      EXPECT_LT((result.cameras[i].p_wc - truth.cameras[i].p_wc).norm(), 1e-7);
      EXPECT_LT((result.cameras[i].R_wc - truth.cameras[i].R_wc).norm(), 1e-7);
    }
  }
}

// Not the approach along the normal: with free rotations the two readings of its homographies
// coincide there, and the cost is flat to the third order.
INSTANTIATE_TEST_SUITE_P(All,
                         PlaneAdjustmentOnMotion,
                         ::testing::Values(Motion::sideways, Motion::orbit, Motion::wander));

TEST(PlaneAdjustment, StaysAtTheTruthOfANoiseFreeApproach) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Simulation truth = simulate({.motion = Motion::approach, .noise_px = 0, .seed = seed});
    const Initialization start = perturbed_truth(truth, {0, 0, 0});
    const Initialization result = refine_on_plane(truth.window, start, PlaneNormal::free, {});
    ASSERT_TRUE(result.ok) << result.reason;
    EXPECT_LT(angle_deg(result.plane.normal, truth.plane.normal), 1e-6);
  }
}

TEST(PlaneAdjustment, DeliversPointsOnItsPlaneInTheGaugeOfTheMethodPage) {
  const Simulation truth = simulate({.motion = Motion::orbit, .off_plane = 0.2});
  const Initialization result =
      refine_on_plane(truth.window, perturbed_truth(truth), PlaneNormal::free, {});
  ASSERT_TRUE(result.ok) << result.reason;
  EXPECT_EQ(result.plane.distance, 1);
  EXPECT_NEAR(result.plane.normal.norm(), 1, 1e-12);
  EXPECT_TRUE(result.cameras[0].R_wc.isIdentity(0));
  EXPECT_EQ(result.cameras[0].p_wc.norm(), 0);
  EXPECT_EQ(result.points.size(), 120U);
  for (const MapPoint& point : result.points)
    EXPECT_NEAR(result.plane.normal.dot(point.position) + 1, 0, 1e-9);
}

TEST(PlaneAdjustment, CountsUnknownsAndResidualsAsThePaperDoes) {
  const Simulation truth = simulate({});
  const Initialization start = perturbed_truth(truth);
  const Initialization free = refine_on_plane(truth.window, start, PlaneNormal::free, {});
  const Initialization held = refine_on_plane(truth.window, start, PlaneNormal::held, {});
  EXPECT_EQ(free.solver.unknowns, 6 * 29 + 2 * 150 + 2);
  EXPECT_EQ(held.solver.unknowns, 6 * 29 + 2 * 150);
  EXPECT_EQ(free.solver.residuals, 2 * 150 * 30);
  EXPECT_LT(free.solver.final_cost, held.solver.final_cost);
  EXPECT_LT(held.solver.final_cost, held.solver.initial_cost);
  EXPECT_NEAR(free.rms_px, 0.5 * std::sqrt(2), 0.05);  // of both coordinates
}

TEST(PlaneAdjustment, HoldsTheNormalToTheBit) {
  const Simulation truth = simulate({.motion = Motion::wander});
  const Initialization start = perturbed_truth(truth);
  const Initialization result = refine_on_plane(truth.window, start, PlaneNormal::held, {});
  ASSERT_TRUE(result.ok) << result.reason;
  EXPECT_EQ(result.plane.normal, start.plane.normal);
}

TEST(PlaneAdjustment, UsesTracksOnlyWhereTheyAreSeen) {
  Simulation truth = simulate({.noise_px = 0});
  for (int i = 10; i < 30; ++i) {
    for (int j = 0; j < 60; ++j) {
      truth.window.points_px[i].col(j).setConstant(std::nan(""));
      truth.window.inlier[i][j] = false;
    }
  }
  const Initialization result =
      refine_on_plane(truth.window, perturbed_truth(truth), PlaneNormal::free, {});
  ASSERT_TRUE(result.ok) << result.reason;
  EXPECT_LT(angle_deg(result.plane.normal, truth.plane.normal), 1e-6);
  EXPECT_EQ(result.solver.residuals, 2 * (150 * 10 + 90 * 20));
}

TEST(PlaneAdjustment, DoesNotDependOnTheOrderOfTracks) {
  const Simulation truth = simulate({.motion = Motion::wander});
  Window reversed = truth.window;
  for (auto& points : reversed.points_px) points = points.rowwise().reverse().eval();
  const Initialization start = perturbed_truth(truth);
  const Initialization a = refine_on_plane(truth.window, start, PlaneNormal::free, {});
  const Initialization b = refine_on_plane(reversed, start, PlaneNormal::free, {});
  EXPECT_LT(angle_deg(a.plane.normal, b.plane.normal), 1e-4);
}

TEST(PlaneAdjustment, IsTheSameToTheBitWhenRepeated) {
  const Simulation truth = simulate({.motion = Motion::wander});
  const Initialization start = perturbed_truth(truth);
  const Initialization a = refine_on_plane(truth.window, start, PlaneNormal::free, {});
  const Initialization b = refine_on_plane(truth.window, start, PlaneNormal::free, {});
  EXPECT_EQ(a.plane.normal, b.plane.normal);
  EXPECT_EQ(a.solver.final_cost, b.solver.final_cost);
}

TEST(PlaneAdjustment, StopsWhenAsked) {
  const Simulation truth = simulate({});
  std::stop_source stop;
  stop.request_stop();
  const Initialization result =
      refine_on_plane(truth.window, perturbed_truth(truth), PlaneNormal::free, stop.get_token());
  EXPECT_FALSE(result.ok);
  EXPECT_LE(result.solver.iterations, 1);
}

}  // namespace
}  // namespace gpo
