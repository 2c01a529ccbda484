// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/candidates/homography_candidates.h"

#include "tests/engine/simulated_window.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::Motion;
using test::simulate;
using test::Simulation;
using test::with_fitted_homographies;
using ::testing::HasSubstr;

TEST(HomographyCandidates, CountInliersBehindCamera) {
  const Simulation truth = simulate({.motion = Motion::oblique, .off_plane = 0.2});
  const std::vector<HomographyCandidate> candidates = decompose_frame(truth.window, 20);
  int rejected = 0;
  for (const HomographyCandidate& candidate : candidates) {
    EXPECT_EQ(candidate.of, 120);
    if (candidate.taken()) {
      EXPECT_LE(candidate.behind, 2);
    }
    if (candidate.rejected.starts_with("points behind")) {
      ++rejected;
      EXPECT_THAT(candidate.rejected, HasSubstr(fmt::format("({} of 120)", candidate.behind)));
    }
  }
  // One of a and -a has all points behind the camera.
  EXPECT_GE(rejected, 1);
}

TEST(HomographyCandidates, AreRejectedForWorseRotationsInEachFrame) {
  const Simulation truth = with_fitted_homographies(simulate({.motion = Motion::oblique}));
  const auto of_frames = candidates_of_window(truth.window);
  ASSERT_EQ(of_frames.size(), 30U);
  EXPECT_TRUE(of_frames[0].empty());
  for (int i = 10; i < 30; ++i) {
    ASSERT_FALSE(of_frames[i].empty());
    auto expected = decompose_frame(truth.window, i);
    reject_worse_rotations(expected);
    ASSERT_EQ(of_frames[i].size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_EQ(of_frames[i][k].frame, i);
      EXPECT_EQ(of_frames[i][k].rejected, expected[k].rejected);
    }
    const HomographyCandidate* best = best_of(of_frames[i]);
    ASSERT_NE(best, nullptr);
    EXPECT_LT(angle_deg(best->motion.normal, truth.plane.normal), 10) << i;
  }
}

TEST(HomographyCandidates, AreEmptyForLostFrame) {
  Simulation truth = simulate({});
  truth.window.H_i1[4].setConstant(std::nan(""));
  truth.window.inlier[4].assign(150, false);
  const auto of_frames = candidates_of_window(truth.window);
  EXPECT_TRUE(of_frames[4].empty());
  EXPECT_FALSE(of_frames[5].empty());
}

TEST(HomographyCandidates, StopOnRequest) {
  std::stop_source source;
  source.request_stop();
  for (const auto& of_frame : candidates_of_window(simulate({}).window, source.get_token()))
    EXPECT_TRUE(of_frame.empty());
}

}  // namespace
}  // namespace gpo
