// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"
#include "engine/methods/initializers.h"
#include "tests/engine/methods/method_cases.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

/// Simulates a fifth of the tracks off the plane and lets the method use them.
Simulation simulate_all_tracks(Motion motion, double noise_px, std::uint64_t seed) {
  Simulation truth =
      simulate({.motion = motion, .noise_px = noise_px, .off_plane = 0.2, .seed = seed});
  truth.window.all_tracks = true;
  return truth;
}

/// Moves every twentieth track by 30 px from some frame on.
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

Initialization refine_free_plane(const Window& window,
                                 const Initialization& start,
                                 const Watch& w) {
  return refine_on_plane<PlaneNormal::free>(window, start, w);
}

class BundleAdjustmentOnMotion : public testing::TestWithParam<Motion> {};

TEST_P(BundleAdjustmentOnMotion, RecoversNoiseFreeWindowsFromPerturbedStarts) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Simulation truth = simulate_all_tracks(GetParam(), 0, seed);
    const Initialization start = perturbed_truth(truth, {.seed = seed});
    const Initialization result = successful(refine_bundle(truth.window, start, {}));
    EXPECT_LT(normal_error_deg(result, truth), 1e-6);
    expect_exact_cameras(result, truth);
    EXPECT_EQ(result.points.size(), 150U);
    EXPECT_EQ(result.solver.residuals, 2 * 150 * 30);
    // If the camera approaches along the normal, the plane adjustment's cost is flat to third
    // order.
    if (GetParam() == Motion::approach) continue;
    const Initialization on_plane = successful(refine_free_plane(truth.window, start, {}));
    EXPECT_LT(normal_error_deg(on_plane, truth), 1e-6);
    expect_exact_cameras(on_plane, truth);
  }
}

TEST_P(BundleAdjustmentOnMotion, IgnoresTracksThatSlip) {
  std::vector<double> clean, slipped;
  for (std::uint64_t seed = 1; seed <= 21; ++seed) {
    Simulation truth = simulate_all_tracks(GetParam(), 0.5, seed);
    const Initialization start = perturbed_truth(truth, {.seed = seed});
    const Initialization without = refine_bundle(truth.window, start, {});
    slip_tracks(truth);
    const Initialization with = refine_bundle(truth.window, start, {});
    ASSERT_TRUE(without.ok && with.ok) << without.reason << with.reason;
    clean.push_back(normal_error_deg(without, truth));
    slipped.push_back(normal_error_deg(with, truth));
    EXPECT_NEAR(with.rms_px, 0.5 * std::sqrt(2), 0.07);
  }
  EXPECT_LT(median(slipped), 1.5 * median(clean));
}

INSTANTIATE_TEST_SUITE_P(All, BundleAdjustmentOnMotion, testing::ValuesIn(kUsualMotions));

TEST(BundleAdjustment, UsesOnlyInliersIfRequested) {
  Simulation truth = simulate_all_tracks(Motion::orbit, 0, 1);
  truth.window.all_tracks = false;
  const Initialization result = successful(refine_bundle(truth.window, perturbed_truth(truth), {}));
  EXPECT_LT(normal_error_deg(result, truth), 1e-6);
  EXPECT_EQ(result.points.size(), 120U);
  EXPECT_EQ(result.solver.residuals, 2 * 120 * 30);
}

TEST(BundleAdjustment, FitsPlaneToInlierPoints) {
  const Simulation truth = simulate_all_tracks(Motion::orbit, 0.5, 1);
  const Initialization result = successful(refine_bundle(truth.window, perturbed_truth(truth), {}));
  EXPECT_TRUE(result.cameras[0].R_wc.isIdentity(0));
  double height = 0;
  int inliers = 0;
  for (const MapPoint& point : result.points) {
    if (!truth.window.is_inlier_track(point.track)) continue;
    height += result.plane.normal.dot(point.position) + 1;
    ++inliers;
  }
  EXPECT_NEAR(height / inliers, 0, 1e-3);
}

TEST(BundleAdjustment, ReportsUnknownsAndCosts) {
  const Simulation truth = simulate({});
  const Initialization result = successful(refine_bundle(truth.window, perturbed_truth(truth), {}));
  EXPECT_EQ(result.solver.unknowns, 6 * 30 + 3 * 150 - 7);
  EXPECT_EQ(result.solver.termination, Termination::convergence);
  EXPECT_LT(result.solver.final_cost, result.solver.initial_cost);
  EXPECT_GT(result.solver.milliseconds, 0);
  EXPECT_NEAR(result.rms_px, 0.5 * std::sqrt(2), 0.07);  // both coordinates
}

TEST(BundleAdjustment, UsesTracksOnlyInFramesThatObserveThem) {
  Simulation off_plane = simulate_all_tracks(Motion::sideways, 0, 1);
  hide_tracks(off_plane.window, 90, 150);
  Simulation flat = simulate({.noise_px = 0});
  hide_tracks(flat.window, 0, 60);
  const Initialization free = refine_bundle(off_plane.window, perturbed_truth(off_plane), {});
  const Initialization on_plane = refine_free_plane(flat.window, perturbed_truth(flat), {});
  ASSERT_TRUE(free.ok && on_plane.ok) << free.reason << on_plane.reason;
  EXPECT_LT(normal_error_deg(free, off_plane), 1e-6);
  EXPECT_LT(normal_error_deg(on_plane, flat), 1e-6);
  for (const auto& result : {free, on_plane})
    EXPECT_EQ(result.solver.residuals, 2 * (150 * 10 + 90 * 20));
}

TEST(BundleAdjustment, IsIndependentOfOrderOfTracks) {
  const Simulation truth = simulate({.motion = Motion::wander});
  const Window reversed = with_reversed_tracks(truth.window);
  const Initialization start = perturbed_truth(truth);
  const Initialization a = refine_bundle(truth.window, start, {});
  const Initialization b = refine_bundle(reversed, start, {});
  EXPECT_NEAR(a.solver.final_cost, b.solver.final_cost, 1e-6);
  EXPECT_LT(angle_deg(a.cameras[29].p_wc, b.cameras[29].p_wc), 1e-4);
  const Initialization c = refine_free_plane(truth.window, start, {});
  const Initialization d = refine_free_plane(reversed, start, {});
  EXPECT_LT(angle_deg(c.plane.normal, d.plane.normal), 1e-4);
}

TEST(BundleAdjustment, RejectsFrameWithoutAgreeingTracks) {
  Simulation truth = simulate_all_tracks(Motion::orbit, 0.5, 1);
  for (int j = 5; j < 150; ++j) truth.window.points_px[12].col(j).setConstant(std::nan(""));
  const Initialization result = refine_bundle(truth.window, perturbed_truth(truth), {});
  EXPECT_FALSE(result.ok);
  EXPECT_THAT(result.reason, HasSubstr("too few tracks agree: frame 12 has"));
}

TEST(BundleAdjustment, StopsOnRequest) {
  const Simulation truth = simulate({});
  const Initialization start = perturbed_truth(truth);
  const Initialization bundle = refine_bundle(truth.window, start, stopped());
  EXPECT_FALSE(bundle.ok);
  EXPECT_LE(bundle.solver.iterations, 2);  // one per round
  const Initialization on_plane = refine_free_plane(truth.window, start, stopped());
  EXPECT_FALSE(on_plane.ok);
  EXPECT_LE(on_plane.solver.iterations, 1);
}

TEST(PlaneAdjustment, StaysAtTruthOfNoiseFreeApproach) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Simulation truth = simulate({.motion = Motion::approach, .noise_px = 0, .seed = seed});
    const Initialization result =
        successful(refine_free_plane(truth.window, perturbed_truth(truth, {0, 0, 0}), {}));
    EXPECT_LT(normal_error_deg(result, truth), 1e-6);
  }
}

TEST(PlaneAdjustment, ReturnsInlierPointsOnItsPlane) {
  const Simulation truth = simulate({.motion = Motion::orbit, .off_plane = 0.2});
  const Initialization result =
      successful(refine_free_plane(truth.window, perturbed_truth(truth), {}));
  EXPECT_TRUE(result.cameras[0].R_wc.isIdentity(0));
  EXPECT_EQ(result.points.size(), 120U);
  for (const MapPoint& point : result.points)
    EXPECT_NEAR(result.plane.normal.dot(point.position) + 1, 0, 1e-9);
}

TEST(PlaneAdjustment, CountsUnknownsAndResidualsLikeThePaper) {
  const Simulation truth = simulate({});
  const Initialization start = perturbed_truth(truth);
  const Initialization free = refine_free_plane(truth.window, start, {});
  const Initialization held = refine_on_plane<PlaneNormal::held>(truth.window, start, {});
  EXPECT_EQ(free.solver.unknowns, 6 * 29 + 2 * 150 + 2);
  EXPECT_EQ(held.solver.unknowns, 6 * 29 + 2 * 150);
  EXPECT_EQ(free.solver.residuals, 2 * 150 * 30);
  EXPECT_LT(free.solver.final_cost, held.solver.final_cost);
  EXPECT_LT(held.solver.final_cost, held.solver.initial_cost);
  EXPECT_NEAR(free.rms_px, 0.5 * std::sqrt(2), 0.05);  // both coordinates
}

TEST(PlaneAdjustment, HoldsNormalExactly) {
  const Simulation truth = simulate({.motion = Motion::wander});
  const Initialization start = perturbed_truth(truth);
  const Initialization result =
      successful(refine_on_plane<PlaneNormal::held>(truth.window, start, {}));
  EXPECT_EQ(result.plane.normal, start.plane.normal);
}

}  // namespace
}  // namespace gpo::test
