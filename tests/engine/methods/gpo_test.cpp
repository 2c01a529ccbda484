// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"
#include "engine/methods/certainty/shared_information.h"
#include "engine/methods/initializers.h"
#include "tests/engine/methods/method_cases.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using ::testing::HasSubstr;

class GpoOnMotion : public ::testing::TestWithParam<Motion> {};

TEST_P(GpoOnMotion, RecoversNoiseFreeWindowsExactly) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Simulation truth = simulate({.motion = GetParam(), .noise_px = 0, .seed = seed});
    const Initialization result = initialize_gpo(truth.window, {}, {});
    ASSERT_TRUE(result.ok) << result.reason;
    EXPECT_LT(normal_error_deg(result, truth), 1e-6);
    expect_exact_cameras(result, truth);
    for (const MapPoint& point : result.points) {
      EXPECT_NEAR(truth.plane.normal.dot(point.position) + 1, 0, 1e-6);
    }
  }
}

TEST_P(GpoOnMotion, ReachesCramerRaoBoundTimesOnePointTwo) {
  std::vector<double> errors;
  std::vector<double> bounds;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Simulation truth = simulate({.motion = GetParam(), .seed = seed});
    const Initialization result = initialize_gpo(truth.window, {}, {});
    ASSERT_TRUE(result.ok) << result.reason;
    errors.push_back(normal_error_deg(result, truth));
    bounds.push_back(*normal_bound_deg(truth.window, truth.plane, truth.cameras, 0.5));
  }
  EXPECT_LE(median(errors), 1.2 * median(bounds));
  // The median length of a two-dimensional Gaussian is 0.83 of its RMS.
  EXPECT_GE(median(errors), 0.5 * median(bounds));
}

INSTANTIATE_TEST_SUITE_P(
    All,
    GpoOnMotion,
    ::testing::Values(Motion::sideways, Motion::orbit, Motion::approach, Motion::wander));

TEST(Gpo, CountsUnknownsAndResidualsLikeThePaper) {
  const Simulation truth = simulate({});
  const Initialization result = initialize_gpo(truth.window, {}, {});
  EXPECT_EQ(result.solver.unknowns, 3 * 30 - 1);
  EXPECT_EQ(result.solver.residuals, 2 * 150 * 29);
  EXPECT_EQ(result.solver.termination, Termination::convergence);
  EXPECT_LE(result.solver.iterations, 300);
  EXPECT_LT(result.solver.final_cost, result.solver.initial_cost);
  EXPECT_NEAR(result.rms_px, 0.5 * std::sqrt(2), 0.05);  // both coordinates
}

TEST(Gpo, IsIndependentOfOrderOfTracks) {
  const Simulation truth = simulate({.motion = Motion::wander});
  const Initialization a = initialize_gpo(truth.window, {}, {});
  const Initialization b = initialize_gpo(with_reversed_tracks(truth.window), {}, {});
  EXPECT_LT(angle_deg(a.plane.normal, b.plane.normal), 1e-6);
}

TEST(Gpo, RotatesNormalWithReferenceFrame) {
  const Simulation truth = simulate({.motion = Motion::orbit, .seed = 3});
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(std::acos(0), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Window turned = truth.window;
  for (int i = 0; i < turned.frame_count(); ++i) {
    const Eigen::Matrix3d H = turned.K * turn * turned.K.inverse();
    turned.points_px[i] =
        (H * truth.window.points_px[i].colwise().homogeneous()).colwise().hnormalized();
    turned.H_i1[i] = H * truth.window.H_i1[i] * H.inverse();
    turned.R_wc[i] = turn * truth.window.R_wc[i] * turn.transpose();
  }
  const Initialization a = initialize_gpo(truth.window, {}, {});
  const Initialization b = initialize_gpo(turned, {}, {});
  EXPECT_LT(angle_deg(turn * a.plane.normal, b.plane.normal), 1e-6);
}

TEST(Gpo, UsesTracksOnlyInFramesThatObserveThem) {
  Simulation truth = simulate({.noise_px = 0});
  hide_tracks(truth.window, 0, 60);
  const Initialization result = initialize_gpo(truth.window, {}, {});
  ASSERT_TRUE(result.ok) << result.reason;
  EXPECT_LT(normal_error_deg(result, truth), 1e-6);
  EXPECT_EQ(result.solver.residuals, 2 * (150 * 9 + 90 * 20));
}

TEST(Gpo, AcceptsLowParallaxOfFourPercent) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    EXPECT_TRUE(initialize_gpo(simulate({.travel = 0.04, .seed = seed}).window, {}, {}).ok);
  }
}

TEST(Gpo, ReportsLeastNumberOfInliers) {
  Simulation truth = simulate({});
  for (int j = 7; j < 150; ++j) truth.window.inlier[12][j] = false;
  const Initialization result = initialize_gpo(truth.window, {}, {});
  EXPECT_FALSE(result.ok);
  EXPECT_EQ(result.reason, "too few inliers: frame 12 has 7, at least 8 are needed");
}

TEST(Gpo, RejectsWrongRotations) {
  Simulation truth = simulate({.motion = Motion::orbit});
  for (int i = 0; i < 30; ++i) truth.window.R_wc[i] = so3_exp({0, 0, 0.02 * i});
  const Initialization result = initialize_gpo(truth.window, {}, {});
  EXPECT_FALSE(result.ok);
  EXPECT_THAT(result.reason, HasSubstr("no convergence"));
}

}  // namespace
}  // namespace gpo::test
