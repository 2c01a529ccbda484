// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/ba.h"

#include "engine/geometry/statistics.h"
#include "engine/window/tracks.h"
#include "engine/window/window.h"
#include "tests/engine/methods/perturbed_truth.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::Motion;
using test::perturbed_truth;
using test::simulate;
using test::Simulation;
using ::testing::HasSubstr;

/// With a fifth of the tracks off the plane, and the method's default of using them.
Simulation simulate_all_tracks(Motion motion, double noise_px, std::uint64_t seed) {
  Simulation truth =
      simulate({.motion = motion, .noise_px = noise_px, .off_plane = 0.2, .seed = seed});
  truth.window.all_tracks = true;
  return truth;
}

/// Every twentieth track jumps by 30 px at some frame and stays there.
void slip_tracks(Simulation& truth) {
  Window& window = truth.window;
  for (int j = 0; j < window.track_count(); j += 20) {
    const double angle = j;
    const Eigen::Vector2d jump = 30 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    for (int i = 3 + 7 * j / 20 % 20; i < window.frame_count(); ++i) {
      window.points_px[i].col(j) += jump;
      window.inlier[i][j] = false;
    }
  }
}

class BundleAdjustmentOnMotion : public ::testing::TestWithParam<Motion> {};

TEST_P(BundleAdjustmentOnMotion, RecoversNoiseFreeWindowsFromPerturbedStarts) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Simulation truth = simulate_all_tracks(GetParam(), 0, seed);
    const Initialization result =
        refine_bundle(truth.window, perturbed_truth(truth, {.seed = seed}), {});
    ASSERT_TRUE(result.ok) << result.reason;
    EXPECT_LT(angle_deg(result.plane.normal, truth.plane.normal), 1e-6);
    for (int i = 0; i < truth.window.frame_count(); ++i) {
      EXPECT_LT((result.cameras[i].p_wc - truth.cameras[i].p_wc).norm(), 1e-7);
      EXPECT_LT((result.cameras[i].R_wc - truth.cameras[i].R_wc).norm(), 1e-7);
    }
    EXPECT_EQ(result.points.size(), 150U);
    EXPECT_EQ(result.solver.residuals, 2 * 150 * 30);
  }
}

TEST_P(BundleAdjustmentOnMotion, IsNotHarmedByTracksThatSlip) {
  std::vector<double> clean;
  std::vector<double> slipped;
  for (std::uint64_t seed = 1; seed <= 21; ++seed) {
    Simulation truth = simulate_all_tracks(GetParam(), 0.5, seed);
    const Initialization start = perturbed_truth(truth, {.seed = seed});
    const Initialization without = refine_bundle(truth.window, start, {});
    slip_tracks(truth);
    const Initialization with = refine_bundle(truth.window, start, {});
    ASSERT_TRUE(without.ok && with.ok) << without.reason << with.reason;
    clean.push_back(angle_deg(without.plane.normal, truth.plane.normal));
    slipped.push_back(angle_deg(with.plane.normal, truth.plane.normal));
    EXPECT_NEAR(with.rms_px, 0.5 * std::sqrt(2), 0.07);
  }
  EXPECT_LT(median(slipped), 1.5 * median(clean));
}

INSTANTIATE_TEST_SUITE_P(
    All,
    BundleAdjustmentOnMotion,
    ::testing::Values(Motion::sideways, Motion::orbit, Motion::approach, Motion::wander));

TEST(BundleAdjustment, UsesOnlyTheInliersWhereTheWindowSaysSo) {
  Simulation truth = simulate_all_tracks(Motion::orbit, 0, 1);
  truth.window.all_tracks = false;
  const Initialization result = refine_bundle(truth.window, perturbed_truth(truth), {});
  ASSERT_TRUE(result.ok) << result.reason;
  EXPECT_LT(angle_deg(result.plane.normal, truth.plane.normal), 1e-6);
  EXPECT_EQ(result.points.size(), 120U);
  EXPECT_EQ(result.solver.residuals, 2 * 120 * 30);
}

TEST(BundleAdjustment, DeliversTheGaugeOfTheMethodPage) {
  const Simulation truth = simulate_all_tracks(Motion::orbit, 0.5, 1);
  const Initialization result = refine_bundle(truth.window, perturbed_truth(truth), {});
  ASSERT_TRUE(result.ok) << result.reason;
  EXPECT_EQ(result.plane.distance, 1);
  EXPECT_NEAR(result.plane.normal.norm(), 1, 1e-12);
  EXPECT_LT(result.plane.normal.z(), 0);
  EXPECT_TRUE(result.cameras[0].R_wc.isIdentity(0));
  EXPECT_EQ(result.cameras[0].p_wc.norm(), 0);
  double height = 0;
  int inliers = 0;
  for (const MapPoint& point : result.points) {
    if (!truth.window.is_inlier_track(point.track)) continue;
    height += result.plane.normal.dot(point.position) + 1;
    ++inliers;
  }
  EXPECT_NEAR(height / inliers, 0, 1e-3);
}

TEST(BundleAdjustment, CountsUnknownsAndWhatTheSolverDid) {
  const Simulation truth = simulate({});
  const Initialization result = refine_bundle(truth.window, perturbed_truth(truth), {});
  ASSERT_TRUE(result.ok) << result.reason;
  EXPECT_EQ(result.solver.unknowns, 6 * 30 + 3 * 150 - 7);
  EXPECT_EQ(result.solver.termination, Termination::convergence);
  EXPECT_LT(result.solver.final_cost, result.solver.initial_cost);
  EXPECT_GT(result.solver.milliseconds, 0);
  EXPECT_NEAR(result.rms_px, 0.5 * std::sqrt(2), 0.07);  // of both coordinates
}

TEST(BundleAdjustment, UsesTracksOnlyWhereTheyAreSeen) {
  Simulation truth = simulate_all_tracks(Motion::sideways, 0, 1);
  for (int i = 10; i < 30; ++i) {
    for (int j = 90; j < 150; ++j) {
      truth.window.points_px[i].col(j).setConstant(std::nan(""));
      truth.window.inlier[i][j] = false;
    }
  }
  const Initialization result = refine_bundle(truth.window, perturbed_truth(truth), {});
  ASSERT_TRUE(result.ok) << result.reason;
  EXPECT_LT(angle_deg(result.plane.normal, truth.plane.normal), 1e-6);
  EXPECT_EQ(result.solver.residuals, 2 * (150 * 10 + 90 * 20));
}

TEST(BundleAdjustment, DoesNotDependOnTheOrderOfTracks) {
  const Simulation truth = simulate({.motion = Motion::wander});
  Window reversed = truth.window;
  for (auto& points : reversed.points_px) points = points.rowwise().reverse().eval();
  const Initialization start = perturbed_truth(truth);
  const Initialization a = refine_bundle(truth.window, start, {});
  const Initialization b = refine_bundle(reversed, start, {});
  EXPECT_NEAR(a.solver.final_cost, b.solver.final_cost, 1e-6);
  EXPECT_LT(angle_deg(a.cameras[29].p_wc, b.cameras[29].p_wc), 1e-4);
}

TEST(BundleAdjustment, IsTheSameToTheBitWhenRepeated) {
  const Simulation truth = simulate_all_tracks(Motion::wander, 0.5, 1);
  const Initialization start = perturbed_truth(truth);
  const Initialization a = refine_bundle(truth.window, start, {});
  const Initialization b = refine_bundle(truth.window, start, {});
  EXPECT_EQ(a.plane.normal, b.plane.normal);
  EXPECT_EQ(a.solver.final_cost, b.solver.final_cost);
}

TEST(BundleAdjustment, RefusesAFrameThatNoTracksAgreeIn) {
  Simulation truth = simulate_all_tracks(Motion::orbit, 0.5, 1);
  for (int j = 5; j < 150; ++j) truth.window.points_px[12].col(j).setConstant(std::nan(""));
  const Initialization result = refine_bundle(truth.window, perturbed_truth(truth), {});
  EXPECT_FALSE(result.ok);
  EXPECT_THAT(result.reason, HasSubstr("too few tracks agree: frame 12 keeps"));
}

TEST(BundleAdjustment, StopsWhenAsked) {
  const Simulation truth = simulate({});
  std::stop_source stop;
  stop.request_stop();
  const Initialization result =
      refine_bundle(truth.window, perturbed_truth(truth), stop.get_token());
  EXPECT_FALSE(result.ok);
  EXPECT_LE(result.solver.iterations, 2);  // one a round
}

}  // namespace
}  // namespace gpo
