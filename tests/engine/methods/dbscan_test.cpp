// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/initializers.h"
#include "tests/engine/methods/method_cases.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::Motion;
using test::simulate;
using test::Simulation;
using test::with_fitted_homographies;
using ::testing::HasSubstr;

double median_dbscan_error_deg(Motion motion) {
  return test::median_normal_error_deg(initialize_dbscan, motion, 30);
}

TEST(Dbscan, NormalErrorIsBelowTenthOfDegree) {
  EXPECT_LT(median_dbscan_error_deg(Motion::sideways), 0.1);
  EXPECT_LT(median_dbscan_error_deg(Motion::orbit), 0.1);
  EXPECT_LT(median_dbscan_error_deg(Motion::wander), 0.12);
}

TEST(Dbscan, AveragesTwinsSeparatedByNoise) {
  // Single decompositions along the normal are off by the square root of the noise, 2 deg.
  EXPECT_LT(median_dbscan_error_deg(Motion::approach), 0.04);
}

TEST(Dbscan, RejectsFalseTwinByGivenRotations) {
  const Simulation truth = simulate({.motion = Motion::oblique, .noise_px = 0});
  const Initialization result = initialize_dbscan(truth.window, {});
  int rejected_by_rotation = 0;
  for (const HomographyCandidate& candidate : result.candidates) {
    const bool is_true = angle_deg(candidate.motion.normal, truth.plane.normal) < 1e-3;
    EXPECT_TRUE(is_true || !candidate.taken());
    if (candidate.rejected.starts_with("rotation")) {
      EXPECT_FALSE(is_true);
      ++rejected_by_rotation;
    }
  }
  EXPECT_GT(rejected_by_rotation, 10);
}

TEST(Dbscan, ReturnsAllDecompositionsOfAllFrames) {
  const Simulation truth = with_fitted_homographies(simulate({.motion = Motion::orbit}));
  const Initialization result = initialize_dbscan(truth.window, {});
  // Four a frame; frames that hardly moved have none.
  EXPECT_EQ(result.candidates.size() % 4, 0U);
  EXPECT_GT(result.candidates.size(), 4U * 25);
  EXPECT_TRUE(std::ranges::any_of(result.candidates, [](const auto& c) { return c.taken(); }));
}

// At 4 % of the plane's distance noise hides which twin is true in single frames: the right one is
// taken or none.
TEST(Dbscan, NeverSelectsFalseTwinAtLowParallax) {
  int told = 0;
  int wrong = 0;
  for (const Motion motion : {Motion::sideways, Motion::orbit, Motion::approach, Motion::oblique}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Simulation truth =
          with_fitted_homographies(simulate({.motion = motion, .travel = 0.04, .seed = seed}));
      const Initialization result = initialize_dbscan(truth.window, {});
      told += result.ok ? 1 : 0;
      wrong += result.ok && angle_deg(result.plane.normal, truth.plane.normal) > 15 ? 1 : 0;
    }
  }
  RecordProperty("told_of_80", told);
  EXPECT_EQ(wrong, 0);
  EXPECT_GE(told, 60);
}

TEST(Dbscan, RejectsAmbiguousTwins) {
  // Rotations halfway between those of both readings.
  Simulation truth = simulate({.motion = Motion::oblique, .noise_px = 0});
  for (int i = 1; i < 30; ++i) {
    const auto pair =
        decompose_homography(truth.window.H_i1[i], truth.window.K, truth.window.points_px[0]);
    ASSERT_EQ(pair.size(), 2U);
    const Eigen::Matrix3d half = so3_exp(so3_log(pair[1].R_21 * pair[0].R_21.transpose()) / 2);
    truth.window.R_wc[i] = (half * pair[0].R_21).transpose();
  }
  const Initialization result = initialize_dbscan(truth.window, {});
  EXPECT_FALSE(result.ok);
  EXPECT_THAT(result.reason, HasSubstr("two plane orientations"));
  EXPECT_FALSE(result.candidates.empty());
}

}  // namespace
}  // namespace gpo
