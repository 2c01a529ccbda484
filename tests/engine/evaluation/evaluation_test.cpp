// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/evaluation/evaluation.h"

#include "engine/geometry/statistics.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/plane/plane_result.h"
#include "tests/engine/simulated_window.h"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

Initialization exact(const Simulation& s) {
  Initialization result;
  result.ok = true;
  result.plane = s.plane;
  result.cameras = s.cameras;
  result.points = lift_to_plane(s.window, s.plane, s.cameras);
  return result;
}

constexpr double kMetersPerUnit = 0.7;

/// Returns the true cameras and plane in another world, in meters.
WindowTruth true_window(const Simulation& s) {
  const Pose T_world_ref{so3_exp({0.4, -1.2, 0.8}), {3, -2, 5}};
  WindowTruth truth{"simulation", {}, {}};
  for (const Pose& camera : s.cameras)
    truth.cameras.push_back(T_world_ref * Pose{camera.R_wc, kMetersPerUnit * camera.p_wc});
  const Eigen::Vector3d n = T_world_ref.R_wc * s.plane.normal;
  truth.plane = Plane{n, kMetersPerUnit * s.plane.distance - n.dot(T_world_ref.p_wc)};
  return truth;
}

Simulation without_noise(Motion motion = Motion::wander) {
  return simulate({.motion = motion, .noise_px = 0});
}

Evaluation evaluated(const Simulation& s, const Initialization& result) {
  return evaluate(result, s.window, true_window(s), 1);
}

TEST(Evaluation, ReportsNoErrorForExactResult) {
  const Simulation s = without_noise();
  const Evaluation e = evaluated(s, exact(s));
  EXPECT_EQ(e.alignment, Alignment::ok);
  EXPECT_NEAR(*e.scale, kMetersPerUnit, 1e-9);
  EXPECT_NEAR(*e.ate_m, 0, 1e-9);
  EXPECT_NEAR(*e.pne_deg, 0, 1e-6);
  EXPECT_NEAR(*e.pne_aligned_deg, 0, 1e-6);
  EXPECT_NEAR(*e.pde_m, 0, 1e-9);
  WindowTruth flipped = true_window(s);
  flipped.plane = Plane{-flipped.plane->normal, -flipped.plane->distance};
  const Evaluation other = evaluate(exact(s), s.window, flipped, 1);
  EXPECT_NEAR(*other.pne_deg, 0, 1e-6) << "whatever the sign of the true normal";
  EXPECT_NEAR(*other.pde_m, 0, 1e-9);
}

TEST(Evaluation, MeasuresNormalErrorAndRootMeanSquareAte) {
  const Simulation s = without_noise();
  Initialization tilted = exact(s);
  const Eigen::Matrix3d R = so3_exp(radians(2.0) * s.plane.normal.unitOrthogonal());
  tilted.plane.normal = R * s.plane.normal;
  for (MapPoint& point : tilted.points) point.position = R * point.position;
  const Evaluation e = evaluated(s, tilted);
  EXPECT_NEAR(*e.pne_deg, 2.0, 1e-6);
  EXPECT_NEAR(*e.pne_aligned_deg, 2.0, 1e-6);
  Initialization noisy = exact(s);
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 0.01);
  for (Pose& camera : noisy.cameras)
    camera.p_wc += Eigen::Vector3d(noise(random), noise(random), noise(random));
  const Evaluation moved = evaluated(s, noisy);
  EXPECT_NEAR(*moved.ate_m, kMetersPerUnit * 0.01 * std::sqrt(3), 0.004);
}

TEST(Evaluation, ShowsAWrongLengthOfThePathThatTheAlignmentHides) {
  const Simulation s = without_noise();
  const Evaluation right = evaluated(s, exact(s));
  EXPECT_NEAR(*right.scale_ratio, 1, 1e-9);
  EXPECT_NEAR(*right.path_error_m, 0, 1e-9);
  EXPECT_NEAR(*right.path_error_percent, 0, 1e-9);
  EXPECT_FALSE(is_contradiction(right));
  Initialization twice = exact(s);
  for (Pose& camera : twice.cameras) camera.p_wc *= 2;
  const Evaluation e = evaluated(s, twice);
  EXPECT_NEAR(*e.ate_m, 0, 1e-9);
  EXPECT_NEAR(*e.scale_ratio, 0.5, 1e-9);
  double squares = 0, length = 0;
  for (std::size_t i = 1; i < s.cameras.size(); ++i) {
    squares += s.cameras[i].p_wc.squaredNorm();
    length += (s.cameras[i].p_wc - s.cameras[i - 1].p_wc).norm();
  }
  const double rms = std::sqrt(squares / static_cast<double>(s.cameras.size()));
  EXPECT_NEAR(*e.path_error_m, kMetersPerUnit * rms, 1e-9);
  EXPECT_NEAR(*e.path_error_percent, 100 * rms / length, 1e-6);
  Initialization other_unit = exact(s);  // imported results have such units
  for (Pose& camera : other_unit.cameras) camera.p_wc *= 3;
  for (MapPoint& point : other_unit.points) point.position *= 3;
  other_unit.plane.distance *= 3;
  EXPECT_NEAR(*evaluated(s, other_unit).scale_ratio, 1, 1e-9);
  EXPECT_NEAR(*evaluated(s, other_unit).path_error_m, 0, 1e-9);
}

TEST(Evaluation, IsAContradictionBeyondTheUncertaintyOfResultAndTruth) {
  const Simulation s = without_noise();
  Initialization tilted = exact(s);
  const Eigen::Matrix3d R = so3_exp(radians(4.0) * s.plane.normal.unitOrthogonal());
  for (MapPoint& point : tilted.points) point.position = R * point.position;
  EXPECT_FALSE(evaluated(s, tilted).pne_sigmas) << "the result has no uncertainty";
  tilted.uncertainty.emplace().normal_sigma_deg = 0.3;
  WindowTruth truth = true_window(s);
  truth.uncertainties.resize(truth.cameras.size());
  truth.uncertainties.front() = PoseUncertainty{.normal_sigma_deg = 0.4};
  const Evaluation e = evaluate(tilted, s.window, truth, 1);
  EXPECT_NEAR(*e.pne_sigmas, 8, 1e-6);
  EXPECT_TRUE(is_contradiction(e));
  truth.uncertainties.front()->normal_sigma_deg = 2;
  EXPECT_FALSE(is_contradiction(evaluate(tilted, s.window, truth, 1)));
}

TEST(Evaluation, StraightPathsHaveNoAlignedNormalAndStationaryCamerasNoScale) {
  const Simulation s = without_noise(Motion::sideways);
  const Evaluation e = evaluated(s, exact(s));
  EXPECT_EQ(e.alignment, Alignment::line);
  EXPECT_FALSE(e.pne_aligned_deg);
  EXPECT_NEAR(*e.scale, kMetersPerUnit, 1e-9);
  EXPECT_NEAR(*e.pne_deg, 0, 1e-6);
  const Simulation still = without_noise(Motion::rotation_only);
  const Evaluation stationary = evaluated(still, exact(still));
  EXPECT_EQ(stationary.alignment, Alignment::point);
  EXPECT_FALSE(stationary.scale || stationary.ate_m || stationary.pde_m ||
               stationary.pne_aligned_deg || stationary.scale_ratio ||
               stationary.path_error_percent);
  EXPECT_TRUE(stationary.pne_deg && stationary.path_error_m);
}

TEST(Evaluation, IgnoresFramesWithoutTruth) {
  const Simulation s = without_noise();
  WindowTruth truth = true_window(s);
  for (int i = 5; i < 15; ++i) truth.cameras[i].reset();
  EXPECT_NEAR(*evaluate(exact(s), s.window, truth, 1).ate_m, 0, 1e-9);
  truth.cameras[0].reset();  // makes the plane unknown in the reference camera's frame
  EXPECT_FALSE(evaluate(exact(s), s.window, truth, 1).pne_deg);
}

TEST(PlaneFit, IgnoresPointsOffPlaneAndRejectsCollinearPoints) {
  const Simulation s = without_noise();
  const Initialization result = exact(s);
  Eigen::Matrix3Xd points(3, result.points.size());
  for (std::size_t k = 0; k < result.points.size(); ++k)
    points.col(k) = result.points[k].position * (k % 4 == 0 ? 0.7 : 1.0);
  const auto plane = fit_plane(points);
  EXPECT_LT(angle_deg(plane->normal, s.plane.normal), 1e-6);
  EXPECT_NEAR(plane->distance, 1, 1e-9);
  for (int k = 0; k < points.cols(); ++k) points.col(k) = Eigen::Vector3d(k, 2 * k, 5 + k);
  EXPECT_FALSE(fit_plane(points));
  EXPECT_FALSE(fit_plane(points.leftCols(2)));
}

TEST(NoiseEstimate, MatchesSimulatedNoise) {
  const Simulation s = simulate({.motion = Motion::wander, .noise_px = 0.5});
  std::vector<double> errors;
  for (int i = 1; i < 30; ++i)
    for (int j = 0; j < 150; ++j) {
      const Eigen::Vector3d y = s.window.H_i1[i] * s.window.points_px[0].col(j).homogeneous();
      errors.push_back((y.hnormalized() - s.window.points_px[i].col(j)).norm());
    }
  EXPECT_NEAR(noise_px(sum_of_squares(errors), 2.0 * errors.size(), 3 * 30 - 1), 0.5, 0.02);
}

/// Returns a window with two planes: the simulated one, and its tracks moved by `moved_px`.
Window with_moved_plane(const Simulation& s, double moved_px) {
  Window window = s.window;
  const int count = window.track_count();
  window.planes.resize(2);
  for (int j = 0; j < count; ++j) window.planes[j % 2].tracks.push_back(j);
  for (int i = 1; i < window.frame_count(); ++i)
    for (const int j : window.planes[0].tracks) window.points_px[i](0, j) += moved_px;
  return window;
}

TEST(PlaneOfTruth, IsTheLeadingOneUnlessTheTracksOfAnotherAgreeBetter) {
  const Simulation s = simulate({.motion = Motion::wander, .noise_px = 0.5});
  EXPECT_EQ(plane_of_truth(s.window, true_window(s)), 0);
  EXPECT_EQ(plane_of_truth(with_moved_plane(s, 0), true_window(s)), 0);
  Window moved = with_moved_plane(s, 20);
  EXPECT_EQ(plane_of_truth(moved, true_window(s)), 1);
  EXPECT_FALSE(evaluate(exact(s), moved, true_window(s), 1).pne_deg);
  moved.leader = 1;
  EXPECT_EQ(plane_of_truth(moved, true_window(s)), 1);
  EXPECT_TRUE(evaluate(exact(s), moved, true_window(s), 1).pne_deg);
}

TEST(PlaneOfTruth, IsTheLeadingOneIfTheTracksContradictIt) {
  const Simulation s = simulate({.motion = Motion::wander, .noise_px = 0.5});
  Window alone = with_moved_plane(s, 20);
  alone.planes.pop_back();
  EXPECT_EQ(plane_of_truth(alone, true_window(s)), 0);
  Window both = with_moved_plane(s, 100);
  for (int i = 1; i < both.frame_count(); ++i)
    for (const int j : both.planes[1].tracks) both.points_px[i](0, j) += 20;
  EXPECT_EQ(plane_of_truth(both, true_window(s)), 0) << "the other is nearer, but does not agree";
}

TEST(PlaneOfTruth, IsNoneIfTheTruthHasNoPlaneInView) {
  const Simulation s = simulate({.motion = Motion::wander, .noise_px = 0.5});
  WindowTruth truth = true_window(s);
  const Eigen::Vector3d& at = truth.cameras.front()->p_wc;
  const double height = truth.plane->normal.dot(at) + truth.plane->distance;
  truth.plane->distance -= 2 * height;  // the mirror image, behind the camera
  EXPECT_EQ(plane_of_truth(s.window, truth), std::nullopt);
  EXPECT_FALSE(evaluate(exact(s), s.window, truth, 1).pne_deg);
  truth.plane.reset();
  EXPECT_EQ(plane_of_truth(s.window, truth), 0);
}

}  // namespace
}  // namespace gpo::test
