// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
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

double median_dbscan_error_deg(Motion motion) {
  return test::median_normal_error_deg(initialize_dbscan, motion, 30);
}

TEST(Dbscan, NormalErrorIsBelowTenthOfDegree) {
  EXPECT_LT(median_dbscan_error_deg(Motion::sideways), 0.1);
  EXPECT_LT(median_dbscan_error_deg(Motion::orbit), 0.1);
  EXPECT_LT(median_dbscan_error_deg(Motion::wander), 0.12);
}

TEST(Dbscan, AveragesTwinsSeparatedByNoise) {
  // For motion along the normal, single decompositions have errors of 2 deg, the root of the noise.
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
  // Four per frame; frames close to the reference frame have none.
  EXPECT_EQ(result.candidates.size() % 4, 0U);
  EXPECT_GT(result.candidates.size(), 4U * 25);
  EXPECT_TRUE(std::ranges::any_of(result.candidates, [](const auto& c) { return c.taken(); }));
}

// At 4 % of the plane distance single frames do not select the twin: the result is correct or none.
TEST(Dbscan, NeverSelectsFalseTwinAtLowParallax) {
  int solved = 0;
  int wrong = 0;
  for (const Motion motion : {Motion::sideways, Motion::orbit, Motion::approach, Motion::oblique}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Simulation truth =
          with_fitted_homographies(simulate({.motion = motion, .travel = 0.04, .seed = seed}));
      const Initialization result = initialize_dbscan(truth.window, {});
      solved += result.ok ? 1 : 0;
      wrong += result.ok && angle_deg(result.plane.normal, truth.plane.normal) > 15 ? 1 : 0;
    }
  }
  RecordProperty("solved_of_80", solved);
  EXPECT_EQ(wrong, 0);
  EXPECT_GE(solved, 60);
}

TEST(Dbscan, RejectsAmbiguousTwins) {
  // Rotations halfway between those of both decompositions.
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
