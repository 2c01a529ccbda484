// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/gpo.h"

#include "engine/geometry/statistics.h"
#include "engine/methods/certainty/shared_information.h"
#include "engine/methods/common/window_checks.h"
#include "engine/window/window.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <numeric>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::Motion;
using test::simulate;
using test::Simulation;
using ::testing::HasSubstr;

double normal_error_deg(const Initialization& result, const Simulation& truth) {
  return angle_deg(result.plane.normal, truth.plane.normal);
}

class GpoOnMotion : public ::testing::TestWithParam<Motion> {};

TEST_P(GpoOnMotion, RecoversNoiseFreeWindowsExactly) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Simulation truth = simulate({.motion = GetParam(), .noise_px = 0, .seed = seed});
    const Initialization result = initialize_gpo(truth.window, {}, {});
    ASSERT_TRUE(result.ok) << result.reason;
    EXPECT_LT(normal_error_deg(result, truth), 1e-6);
    for (int i = 0; i < truth.window.frame_count(); ++i) {
      EXPECT_LT((result.cameras[i].p_wc - truth.cameras[i].p_wc).norm(), 1e-7) << "frame " << i;
    }
    for (const MapPoint& point : result.points) {
      EXPECT_NEAR(truth.plane.normal.dot(point.position) + 1, 0, 1e-6);
    }
  }
}

TEST_P(GpoOnMotion, MedianNormalErrorIsWithinTheCramerRaoBoundTimesOnePointTwo) {
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
  // Nor can it beat the bound: the median of a two-dimensional Gaussian's length is 0.83 of its
  // RMS.
  EXPECT_GE(median(errors), 0.5 * median(bounds));
}

INSTANTIATE_TEST_SUITE_P(
    All,
    GpoOnMotion,
    ::testing::Values(Motion::sideways, Motion::orbit, Motion::approach, Motion::wander));

TEST(Gpo, CountsUnknownsAndResidualsAsThePaperDoes) {
  const Simulation truth = simulate({});
  const Initialization result = initialize_gpo(truth.window, {}, {});
  EXPECT_EQ(result.solver.unknowns, 3 * 30 - 1);
  EXPECT_EQ(result.solver.residuals, 2 * 150 * 29);
  EXPECT_EQ(result.solver.termination, Termination::convergence);
  EXPECT_LE(result.solver.iterations, 300);
  EXPECT_LT(result.solver.final_cost, result.solver.initial_cost);
  EXPECT_NEAR(result.rms_px, 0.5 * std::sqrt(2), 0.05);  // of both coordinates
}

TEST(Gpo, DeliversTheGaugeOfTheMethodPage) {
  const Simulation truth = simulate({.motion = Motion::orbit});
  const Initialization result = initialize_gpo(truth.window, {}, {});
  EXPECT_EQ(result.plane.distance, 1);
  EXPECT_NEAR(result.plane.normal.norm(), 1, 1e-12);
  EXPECT_LT(result.plane.normal.z(), 0);
  EXPECT_EQ(result.cameras[0].p_wc.norm(), 0);
  EXPECT_TRUE(result.cameras[0].R_wc.isIdentity());
}

TEST(Gpo, DoesNotDependOnTheOrderOfTracks) {
  const Simulation truth = simulate({.motion = Motion::wander});
  Window reversed = truth.window;
  for (auto& points : reversed.points_px) points = points.rowwise().reverse().eval();
  const Initialization a = initialize_gpo(truth.window, {}, {});
  const Initialization b = initialize_gpo(reversed, {}, {});
  EXPECT_LT(angle_deg(a.plane.normal, b.plane.normal), 1e-6);
}

TEST(Gpo, FollowsARotatedReferenceFrame) {
  // The same pictures with the image axes turned by 90 degrees give the normal turned by 90
  // degrees.
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

TEST(Gpo, UsesTracksOnlyWhereTheyAreSeen) {
  Simulation truth = simulate({.noise_px = 0});
  for (int i = 10; i < 30; ++i) {
    for (int j = 0; j < 60; ++j) {
      truth.window.points_px[i].col(j).setConstant(std::nan(""));
      truth.window.inlier[i][j] = false;
    }
  }
  const Initialization result = initialize_gpo(truth.window, {}, {});
  ASSERT_TRUE(result.ok) << result.reason;
  EXPECT_LT(normal_error_deg(result, truth), 1e-6);
  EXPECT_EQ(result.solver.residuals, 2 * (150 * 9 + 90 * 20));
}

TEST(Gpo, FailsOnPureRotationWithAReason) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Simulation truth = simulate({.motion = Motion::rotation_only, .seed = seed});
    const Initialization result = initialize_gpo(truth.window, {}, {});
    EXPECT_FALSE(result.ok);
    EXPECT_THAT(result.reason, HasSubstr("no parallax"));
    EXPECT_TRUE(result.cameras.empty());
    EXPECT_TRUE(result.points.empty());
  }
}

TEST(Gpo, AcceptsLowParallaxOfFourPercent) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    EXPECT_TRUE(initialize_gpo(simulate({.travel = 0.04, .seed = seed}).window, {}, {}).ok);
  }
}

TEST(Gpo, NamesTheLeastNumberOfInliers) {
  Simulation truth = simulate({});
  for (int j = 7; j < 150; ++j) truth.window.inlier[12][j] = false;
  const Initialization result = initialize_gpo(truth.window, {}, {});
  EXPECT_FALSE(result.ok);
  EXPECT_EQ(result.reason, "too few inliers: frame 12 has 7, at least 8 are needed");
}

TEST(Gpo, RefusesRotationsThatDoNotBelongToTheImages) {
  Simulation truth = simulate({.motion = Motion::orbit});
  for (int i = 0; i < 30; ++i) truth.window.R_wc[i] = so3_exp({0, 0, 0.02 * i});
  const Initialization result = initialize_gpo(truth.window, {}, {});
  EXPECT_FALSE(result.ok);
  EXPECT_THAT(result.reason, HasSubstr("no convergence"));
}

TEST(Gpo, IsTheSameToTheBitWhenRepeated) {
  const Simulation truth = simulate({.motion = Motion::wander});
  const Initialization a = initialize_gpo(truth.window, {}, {});
  const Initialization b = initialize_gpo(truth.window, {}, {});
  EXPECT_EQ(a.plane.normal, b.plane.normal);
  EXPECT_EQ(a.solver.final_cost, b.solver.final_cost);
}

}  // namespace
}  // namespace gpo
