// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/pose.h"
#include "engine/methods/candidates/density_clusters.h"
#include "engine/methods/candidates/homography_candidates.h"
#include "tests/engine/methods/method_cases.h"

#include <algorithm>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using Eigen::Vector3d;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

/// On the equator, at a longitude [deg].
WeightedDirection at(double longitude_deg, double weight = 1) {
  const double angle = radians(longitude_deg);
  return {{std::cos(angle), std::sin(angle), 0}, weight};
}

std::vector<int> clusters_of(const std::vector<WeightedDirection>& points) {
  return density_clusters(points, {.radius_deg = 1.01, .least_weight = 3});
}

TEST(DensityClusters, ChainCorePointsAndLeaveNoiseFromTheHeaviestOn) {
  EXPECT_THAT(clusters_of({at(0), at(0), at(0), at(90), at(90), at(90), at(90)}),
              ElementsAre(1, 1, 1, 0, 0, 0, 0));
  EXPECT_THAT(clusters_of({at(0), at(1), at(2), at(3), at(50), at(90), at(91), at(92)}),
              ElementsAre(0, 0, 0, 0, kNoise, 1, 1, 1));
}

TEST(DensityClusters, BorderPointsJoinNearestCore) {
  // 2.4 has two neighbors, core points of two clusters, 0.9 and 0.8 away.
  const std::vector<WeightedDirection> points{
      at(0.5), at(0.7), at(1), at(1.5), at(2.4), at(3.2), at(3.7), at(3.9), at(4.2)};
  const auto labels = density_clusters(points, {.radius_deg = 1.01, .least_weight = 4});
  EXPECT_THAT(labels, ElementsAre(1, 1, 1, 1, 0, 0, 0, 0, 0));
}

TEST(DensityClusters, PointsFormClusterOnlyWithEnoughWeight) {
  EXPECT_THAT(clusters_of({at(0), at(1)}), Each(kNoise));
  EXPECT_THAT(clusters_of({at(0, 2), at(1, 2)}), Each(0));
  EXPECT_THAT(clusters_of({at(0, 3)}), Each(0));
  EXPECT_TRUE(clusters_of({}).empty());
}

TEST(DensityClusters, DistanceIsAngleOnSphere) {
  // Across the pole, and never to the antipode.
  const auto near_pole = [](double x, double z) {
    return WeightedDirection{Vector3d(std::sin(radians(x)), 0, z * std::cos(radians(x)))};
  };
  EXPECT_THAT(clusters_of({near_pole(-0.5, 1),
                           near_pole(0, 1),
                           near_pole(0.5, 1),
                           near_pole(-0.5, -1),
                           near_pole(0, -1)}),
              ElementsAre(0, 0, 0, kNoise, kNoise));
}

TEST(DensityClusters, AreIndependentOfOrder) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise;
  std::vector<WeightedDirection> points;
  for (int k = 0; k < 120; ++k) {
    const Vector3d center = k % 3 == 0 ? Vector3d::UnitX() : Vector3d(0, 0.1, 1);
    points.push_back({(center + (k % 3 == 2 ? 0.5 : 0.02) *
                                    Vector3d(noise(random), noise(random), noise(random)))
                          .normalized()});
  }
  const auto labels = clusters_of(points);
  EXPECT_GE(*std::ranges::max_element(labels), 1);
  for (int repeat = 0; repeat < 10; ++repeat) {
    std::vector<int> order(points.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<int>(k);
    std::ranges::shuffle(order, random);
    std::vector<WeightedDirection> shuffled;
    for (const int k : order) shuffled.push_back(points[k]);
    const auto again = clusters_of(shuffled);
    for (std::size_t k = 0; k < order.size(); ++k) {
      for (std::size_t l = 0; l < order.size(); ++l) {
        EXPECT_EQ(again[k] == again[l], labels[order[k]] == labels[order[l]]);
      }
    }
  }
}

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
  for (const auto& of_frame : candidates_of_window(simulate({}).window, stopped()))
    EXPECT_TRUE(of_frame.empty());
}

}  // namespace
}  // namespace gpo::test
