// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/initializers.h"
#include "tests/engine/methods/method_cases.h"

#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::Motion;
using test::simulate;
using test::Simulation;
using test::with_fitted_homographies;
using ::testing::HasSubstr;

double median_pnp_error_deg(Motion motion) {
  return test::median_normal_error_deg(initialize_pnp, motion, 15);
}

TEST(Pnp, NormalErrorIsBelowQuarterOfDegree) {
  EXPECT_LT(median_pnp_error_deg(Motion::sideways), 0.25);
  EXPECT_LT(median_pnp_error_deg(Motion::orbit), 0.25);
  EXPECT_LT(median_pnp_error_deg(Motion::wander), 0.3);
}

TEST(Pnp, AveragesTwinsSeparatedByNoise) {
  // Each decomposition has an error of 2 to 3 deg.
  EXPECT_LT(median_pnp_error_deg(Motion::approach), 0.1);
}

TEST(Pnp, ReturnsTriangulatedPointsAndErrors) {
  const Simulation truth = with_fitted_homographies(simulate({.motion = Motion::orbit}));
  const Initialization result = initialize_pnp(truth.window, {});
  ASSERT_TRUE(result.ok) << result.reason;
  double off_plane = 0;
  for (const MapPoint& point : result.points) {
    const double height = std::abs(result.plane.normal.dot(point.position) + 1);
    EXPECT_LT(height, 0.05);
    off_plane = std::max(off_plane, height);
  }
  EXPECT_GT(off_plane, 1e-5);  // not projected onto the plane
  const auto errors = reprojection_errors_px(truth.window, result.cameras, result.points);
  EXPECT_EQ(errors.size(), 30U * 150U);
  EXPECT_EQ(result.rms_px, root_mean_square(errors));
  EXPECT_LT(result.rms_px, 0.5 * std::sqrt(2));  // free points absorb some of the noise
  EXPECT_EQ(result.solver.termination, Termination::none);
}

TEST(Pnp, IgnoresOutliersAmongInliers) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Simulation truth = with_fitted_homographies(simulate({.motion = Motion::orbit, .seed = seed}));
    for (int i = 1; i < 30; ++i) {
      for (int j = i % 7; j < 150; j += 15)
        truth.window.points_px[i].col(j) += Eigen::Vector2d(12, 9);
    }
    const Initialization result = initialize_pnp(truth.window, {});
    ASSERT_TRUE(result.ok) << result.reason;
    EXPECT_LT(angle_deg(result.plane.normal, truth.plane.normal), 2);
  }
}

TEST(Pnp, SelectsWidestPairWithEnoughTracks) {
  Simulation truth = simulate({.motion = Motion::orbit, .noise_px = 0});
  for (int j = 40; j < 150; ++j) truth.window.inlier[29][j] = false;
  const Initialization result = initialize_pnp(truth.window, {});
  ASSERT_TRUE(result.ok) << result.reason;
  ASSERT_EQ(result.candidates.size(), 8U);
  EXPECT_THAT(result.candidates[0].rejected + result.candidates[1].rejected +
                  result.candidates[2].rejected + result.candidates[3].rejected,
              HasSubstr("only 40 of 150 tracks"));
  EXPECT_EQ(result.candidates[0].frame, 29);
  EXPECT_EQ(result.candidates[4].frame, 28);
  EXPECT_EQ(std::ranges::count(result.candidates, "", &HomographyCandidate::rejected), 1);
}

TEST(Pnp, ReportsWhyAllPairsAreUnsuitable) {
  Simulation truth = simulate({.motion = Motion::orbit, .noise_px = 0});
  truth.window.start = 100;
  for (int i = 1; i < 30; ++i) truth.window.R_wc[i] = truth.window.R_wc[i] * so3_exp({0, 0, 0.2});
  const Initialization result = initialize_pnp(truth.window, {});
  EXPECT_FALSE(result.ok);
  EXPECT_THAT(result.reason, HasSubstr("no pair to start from: frame 129: rotation 11."));
  EXPECT_GE(result.candidates.size(), 4U * 28);
  for (const HomographyCandidate& candidate : result.candidates) EXPECT_FALSE(candidate.taken());
}

TEST(Pnp, ReportsReasonsForRejection) {
  const Simulation truth = simulate({.motion = Motion::oblique, .noise_px = 0});
  const Initialization result = initialize_pnp(truth.window, {});
  ASSERT_EQ(result.candidates.size(), 4U);
  std::string reasons;
  for (const HomographyCandidate& candidate : result.candidates)
    reasons += candidate.rejected + "\n";
  EXPECT_THAT(reasons, HasSubstr("points behind the camera (150 of 150)"));
  EXPECT_THAT(reasons, HasSubstr("deg from the given rotation,"));
}

}  // namespace
}  // namespace gpo
