// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/normal_landscape.h"

#include "engine/geometry/statistics.h"
#include "engine/methods/candidates/homography_candidates.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/plane/linear_solutions.h"
#include "tests/engine/methods/method_cases.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

constexpr int kSide = 64;
/// Half the diagonal of a cell.
const double kCellDeg = 90 * std::sqrt(2.0) / kSide;

Eigen::Vector3d normal_of_cell(int cell) {
  return normal_from_disc(disc_of_cell(kSide, cell / kSide, cell % kSide));
}

int cell_of(const Eigen::Vector3d& normal) {
  const Eigen::Vector2d at = (disc_from_normal(normal).array() + 1) / 2 * kSide;
  return static_cast<int>(at.y()) * kSide + static_cast<int>(at.x());
}

int least_cell(const std::vector<float>& rms) {
  int least = -1;
  for (int cell = 0; cell < static_cast<int>(rms.size()); ++cell) {
    if (std::isfinite(rms[cell]) && (least < 0 || rms[cell] < rms[least])) least = cell;
  }
  return least;
}

/// Returns the RMS error with translations from three rounds of least squares.
double brute_force_rms_px(const Window& window, const Eigen::Vector3d& normal) {
  std::vector<Pose> cameras(window.frame_count());
  for (int i = 1; i < window.frame_count(); ++i)
    cameras[i] = {window.R_wc[i], -translation_given_normal(window, i, normal)};
  return root_mean_square(reprojection_errors_px(window, {normal, 1}, cameras));
}

TEST(NormalDisc, HasFacingPlaneInCenterAndImageAxes) {
  EXPECT_EQ(disc_from_normal({0, 0, -1}), Eigen::Vector2d(0, 0));
  EXPECT_LT((disc_from_normal({1, 0, 0}) - Eigen::Vector2d(1, 0)).norm(), 1e-12);
  EXPECT_LT(
      (disc_from_normal({0, std::sqrt(0.5), -std::sqrt(0.5)}) - Eigen::Vector2d(0, 0.5)).norm(),
      1e-12);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (int k = 0; k < 1000; ++k) {
    const Eigen::Vector2d disc(coordinate(random), coordinate(random));
    EXPECT_NEAR(normal_from_disc(disc).norm(), 1, 1e-12);
    EXPECT_LT((disc_from_normal(normal_from_disc(disc)) - disc).norm(), 1e-9);
  }
}

TEST(NormalLandscape, HasMinimumAtTrueNormalWithoutNoise) {
  for (const Motion motion : kMotions)
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const Simulation truth = simulate({.motion = motion, .noise_px = 0, .seed = seed});
      const auto landscape = normal_landscape(truth.window, kSide);
      const int least = least_cell(rms_px(*landscape, 30));
      ASSERT_GE(least, 0);
      EXPECT_LT(angle_deg(normal_of_cell(least), truth.plane.normal), 2 * kCellDeg)
          << static_cast<int>(motion);
    }
}

TEST(NormalLandscape, MatchesResidualOfBestTranslations) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> any_cell(0, kSide * kSide - 1);
  for (const Motion motion : kMotions) {
    const Simulation truth = simulate_fitted({.motion = motion});
    const std::vector<float> rms = rms_px(*normal_landscape(truth.window, kSide), 30);
    for (int k = 0; k < 40; ++k) {
      const int cell = k == 0 ? cell_of(truth.plane.normal) : any_cell(random);
      if (!std::isfinite(rms[cell])) continue;
      const double expected = brute_force_rms_px(truth.window, normal_of_cell(cell));
      EXPECT_NEAR(rms[cell], expected, 0.04 * expected)
          << static_cast<int>(motion) << " " << normal_of_cell(cell).transpose();
    }
  }
}

TEST(NormalLandscape, IsFlatWithoutTranslation) {
  const Simulation truth = simulate_fitted({.motion = Motion::rotation_only, .noise_px = 0.5});
  const std::vector<float> rms = rms_px(*normal_landscape(truth.window, kSide), 30);
  int seen = 0;
  for (const float value : rms) {
    if (!std::isfinite(value)) continue;
    ++seen;
    EXPECT_NEAR(value, 0.5 * std::sqrt(2), 0.05);
  }
  EXPECT_GT(seen, kSide * kSide / 8);
}

TEST(NormalLandscape, IsNanIfHorizonRunsThroughPoints) {
  const Simulation truth = simulate({});
  const auto landscape = normal_landscape(truth.window, kSide);
  for (int cell = 0; cell < kSide * kSide; ++cell) {
    const Eigen::Vector2d disc = disc_of_cell(kSide, cell / kSide, cell % kSide);
    bool seen = disc.norm() < 1;
    for (int j = 0; j < truth.window.track_count(); ++j) {
      const Eigen::Vector3d ray =
          truth.window.K.inverse() * truth.window.points_px[0].col(j).homogeneous();
      seen = seen && normal_from_disc(disc).dot(ray) < 0;
    }
    for (int i = 0; i < 30; ++i) EXPECT_EQ(std::isnan(landscape->cost_px2[i][cell]), !seen);
  }
}

// Only the window's rotation distinguishes the true decomposition of one homography from its twin.
TEST(NormalLandscape, HasMinimumAtTwinForTwinsRotation) {
  const Simulation truth = simulate({.motion = Motion::oblique, .frames = 2, .noise_px = 0});
  int feasible = 0;
  for (const HomographyCandidate& candidate : decompose_frame(truth.window, 1)) {
    if (!candidate.taken()) continue;
    ++feasible;
    Window window = truth.window;
    window.R_wc[1] = candidate.motion.R_21.transpose();
    const int least = least_cell(rms_px(*normal_landscape(window, kSide), 2));
    EXPECT_LT(angle_deg(normal_of_cell(least), candidate.motion.normal), 2 * kCellDeg);
  }
  EXPECT_EQ(feasible, 2);
}

TEST(NormalLandscape, CountsOnlyFirstFrames) {
  const Simulation truth = simulate({.motion = Motion::orbit});
  const auto landscape = normal_landscape(truth.window, 16);
  EXPECT_EQ(landscape->observations[0], 0);
  EXPECT_EQ(landscape->observations[1], 150);
  const int cell = 8 * 16 + 8;
  EXPECT_NEAR(rms_px(*landscape, 2)[cell], std::sqrt(2 * landscape->cost_px2[1][cell] / 150), 1e-4);
}

TEST(NormalLandscape, StopsOnRequest) {
  EXPECT_FALSE(normal_landscape(simulate({}).window, kSide, stopped()));
}

}  // namespace
}  // namespace gpo::test
