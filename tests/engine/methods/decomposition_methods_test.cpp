// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"
#include "engine/methods/candidates/homography_candidates.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/initializers.h"
#include "engine/methods/plane/linear_solutions.h"
#include "tests/engine/methods/method_cases.h"

#include <algorithm>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using Eigen::Vector3d, testing::Each, testing::ElementsAre, testing::HasSubstr;

/// Returns the median normal error over seeds [deg], on default windows with homographies fitted to
/// noisy tracks. A failure of the method is a failure of the test.
double median_normal_error_deg(Initialization (*initialize)(const Window&, const Watch&),
                               Motion motion,
                               std::uint64_t seeds) {
  std::vector<double> errors;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Simulation truth = simulate_fitted({.motion = motion, .seed = seed});
    const Initialization result = initialize(truth.window, {});
    EXPECT_TRUE(result.ok) << result.reason;
    if (result.ok) errors.push_back(normal_error_deg(result, truth));
  }
  return median(std::move(errors));
}

// For motion along the normal, single decompositions have errors of 2 to 3 deg, the root of the
// noise.
TEST(DecompositionMethods, AverageToSmallNormalErrors) {
  struct Limits {
    Motion motion;
    double dbscan_deg, pnp_deg;
  };
  for (const auto& [motion, dbscan_deg, pnp_deg] : {Limits{Motion::sideways, 0.1, 0.25},
                                                    {Motion::orbit, 0.1, 0.25},
                                                    {Motion::wander, 0.12, 0.3},
                                                    {Motion::approach, 0.04, 0.1}}) {
    SCOPED_TRACE(static_cast<int>(motion));
    EXPECT_LT(median_normal_error_deg(initialize_dbscan, motion, 30), dbscan_deg);
    EXPECT_LT(median_normal_error_deg(initialize_pnp, motion, 15), pnp_deg);
  }
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
  const Simulation truth = simulate_fitted({.motion = Motion::orbit});
  const Initialization result = initialize_dbscan(truth.window, {});
  // Four per frame; frames close to the reference frame have none.
  EXPECT_EQ(result.candidates.size() % 4, 0U);
  EXPECT_GT(result.candidates.size(), 4U * 25);
  EXPECT_TRUE(std::ranges::any_of(result.candidates, [](const auto& c) { return c.taken(); }));
}

// At 4 % of the plane distance single frames do not select the twin: the result is correct or none.
TEST(Dbscan, NeverSelectsFalseTwinAtLowParallax) {
  int solved = 0, wrong = 0;
  for (const Motion motion : {Motion::sideways, Motion::orbit, Motion::approach, Motion::oblique})
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Simulation truth = simulate_fitted({.motion = motion, .travel = 0.04, .seed = seed});
      const Initialization result = initialize_dbscan(truth.window, {});
      solved += result.ok ? 1 : 0;
      wrong += result.ok && normal_error_deg(result, truth) > 15 ? 1 : 0;
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

TEST(Pnp, ReturnsTriangulatedPointsAndErrors) {
  const Simulation truth = simulate_fitted({.motion = Motion::orbit});
  const Initialization result = successful(initialize_pnp(truth.window, {}));
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
    Simulation truth = simulate_fitted({.motion = Motion::orbit, .seed = seed});
    for (int i = 1; i < 30; ++i)
      for (int j = i % 7; j < 150; j += 15)
        truth.window.points_px[i].col(j) += Eigen::Vector2d(12, 9);
    const Initialization result = successful(initialize_pnp(truth.window, {}));
    EXPECT_LT(normal_error_deg(result, truth), 2);
  }
}

TEST(Pnp, SelectsWidestPairWithEnoughTracks) {
  Simulation truth = simulate({.motion = Motion::orbit, .noise_px = 0});
  for (int j = 40; j < 150; ++j) truth.window.inlier[29][j] = false;
  const Initialization result = successful(initialize_pnp(truth.window, {}));
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

/// Returns the length of a path that stays in front of the plane.
double longest_travel(Motion motion) {
  const bool along = motion == Motion::sideways || motion == Motion::up_down;
  return along || motion == Motion::wander ? 1.2 : 0.6;
}

TEST(ClosedForm, IsExactWithoutNoise) {
  for (const Motion motion : kMotions)
    for (const double travel : {0.04, 0.3, longest_travel(motion)}) {
      const Simulation truth =
          simulate({.motion = motion, .noise_px = 0, .travel = travel, .tilt_deg = 20, .seed = 3});
      const auto found = closed_form_motion(truth.window);
      ASSERT_TRUE(found);
      EXPECT_LT(angle_deg(found->normal, truth.plane.normal), 1e-4);
      for (std::size_t i = 0; i < found->tau.size(); ++i)
        EXPECT_LT((found->tau[i] + truth.cameras[i].p_wc).norm(), 1e-6);
    }
}

TEST(ClosedForm, IgnoresScaleAndSignOfHomographies) {
  Simulation truth = simulate({.noise_px = 0});
  for (std::size_t i = 0; i < truth.window.H_i1.size(); ++i)
    truth.window.H_i1[i] *= i % 2 == 0 ? -3.0 : 0.2;
  EXPECT_LT(angle_deg(closed_form_motion(truth.window)->normal, truth.plane.normal), 1e-4);
}

TEST(ClosedForm, GivesGpoAStartThatConverges) {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const Motion motion = kMotions[seed % std::size(kMotions)];
    const double travels[] = {0.04, 0.3, longest_travel(motion)};
    const Simulation truth = simulate_fitted({.motion = motion,
                                              .travel = travels[seed % 3],
                                              .tilt_deg = 10.0 + static_cast<double>(seed % 30),
                                              .gyro_bias_rad_s = 0.002,
                                              .seed = seed});
    const Initialization result = initialize_gpo(truth.window, {}, {});
    // Errors are a few degrees at low parallax, tens of degrees for the wrong twin.
    EXPECT_TRUE(result.ok) << result.reason << " " << seed;
    if (!result.ok) continue;
    EXPECT_LT(normal_error_deg(result, truth), 15) << seed;
  }
}

TEST(ClosedForm, RejectsMissingHomography) {
  Simulation truth = simulate({});
  truth.window.H_i1[4].setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(closed_form_motion(truth.window));
}

/// On the equator, at a longitude [deg].
WeightedDirection at(double longitude_deg, double weight = 1) {
  const double angle = radians(longitude_deg);
  return {{std::cos(angle), std::sin(angle), 0}, weight};
}

std::vector<int> clusters_of(const std::vector<WeightedDirection>& points) {
  return density_clusters(points, 1.01, 3);
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
  const auto labels = density_clusters(points, 1.01, 4);
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
    std::iota(order.begin(), order.end(), 0);
    std::ranges::shuffle(order, random);
    std::vector<WeightedDirection> shuffled;
    for (const int k : order) shuffled.push_back(points[k]);
    const auto again = clusters_of(shuffled);
    for (std::size_t k = 0; k < order.size(); ++k)
      for (std::size_t l = 0; l < order.size(); ++l)
        EXPECT_EQ(again[k] == again[l], labels[order[k]] == labels[order[l]]);
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
  const Simulation truth = simulate_fitted({.motion = Motion::oblique});
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
