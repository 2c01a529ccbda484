// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/planes/inliers.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <iterator>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Vector2d;

/// Points of a window, and the columns of an overlay.
struct Covered {
  std::vector<Matrix2Xd> points_px;
  std::vector<int> overlay;
};

/// Stops the tracks in the lower part of the image, a share of all.
Covered covered(std::vector<Matrix2Xd> points_px, double share, double noise_px) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, noise_px);
  std::vector<double> rows;
  for (const auto& point : points_px[0].colwise()) rows.push_back(point.y());
  std::ranges::sort(rows);
  const double first_row = rows[static_cast<std::size_t>((1 - share) * (std::ssize(rows) - 1))];
  Covered result{std::move(points_px), {}};
  for (int j = 0; j < result.points_px[0].cols(); ++j) {
    if (result.points_px[0](1, j) <= first_row) continue;
    result.overlay.push_back(j);
    for (std::size_t i = 1; i < result.points_px.size(); ++i)
      result.points_px[i].col(j) =
          result.points_px[0].col(j) + Vector2d(noise(random), noise(random));
  }
  return result;
}

/// Tracks of a camera that zooms without any other motion: x of each is `scale` times farther from
/// the middle in the last frame.
std::vector<Matrix2Xd> zoomed(double scale, int frames, double noise_px, double roll_rad = 0) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, noise_px);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Vector2d middle(320, 240);
  Matrix2Xd first(2, 300);
  for (auto point : first.colwise()) point << 310 * uniform(random), 230 * uniform(random);
  std::vector<Matrix2Xd> points_px;
  for (int i = 0; i < frames; ++i) {
    const double s = i / (frames - 1.0);
    const double factor = 1 + s * (scale - 1);
    const Matrix2Xd moved = factor * Eigen::Rotation2Dd(s * roll_rad).toRotationMatrix() * first;
    points_px.push_back(moved.colwise() + middle);
    for (auto point : points_px.back().colwise()) point += Vector2d(noise(random), noise(random));
  }
  return points_px;
}

TEST(StaticTracks, FindsOverlaysOfAnySize) {
  for (const int frames : {3, 10, 30}) {
    for (const Motion motion : kMotions) {
      for (const double share : {0.1, 0.26, 0.64, 0.8}) {
        SimulationOptions options = noisy(motion, 5, 0.1);
        options.frames = frames;
        const Covered window = covered(simulate(options).window.points_px, share, 0.1);
        const std::vector<int> found = static_tracks(window.points_px, {}, 1);
        std::vector<int> wrong;
        std::ranges::set_difference(found, window.overlay, std::back_inserter(wrong));
        EXPECT_EQ(wrong, std::vector<int>{}) << frames << " frames, motion " << int(motion);
        EXPECT_GE(std::ssize(found), 0.9 * std::ssize(window.overlay))
            << frames << " frames, motion " << int(motion) << ", share " << share;
      }
    }
  }
}

TEST(StaticTracks, AreNotAmongHonestTracks) {
  for (const int frames : {2, 3, 10, 30}) {
    for (const double travel : {0.001, 0.01, 0.3}) {
      for (const double noise_px : {0.0, 0.1, 0.5}) {
        for (int motion = 0; motion <= static_cast<int>(Motion::rotation_only); ++motion) {
          SimulationOptions options = noisy(static_cast<Motion>(motion), 11, noise_px);
          options.frames = frames;
          options.travel = travel;
          options.off_plane = 0.3;
          const auto points_px = simulate(options).window.points_px;
          EXPECT_EQ(static_tracks(points_px, {}, 1), std::vector<int>{})
              << frames << " frames, motion " << motion << ", noise " << noise_px;
        }
      }
    }
  }
}

TEST(StaticTracks, AreNotAroundTheFocusOfExpansion) {
  for (const int frames : {2, 3, 10, 30}) {
    for (const double scale : {1.003, 1.01, 1.03, 1.3})
      EXPECT_EQ(static_tracks(zoomed(scale, frames, 0.1), {}, 1), std::vector<int>{}) << scale;
    for (const double roll_rad : {0.003, 0.01, 0.03, 0.3})
      EXPECT_EQ(static_tracks(zoomed(1, frames, 0.1, roll_rad), {}, 1), std::vector<int>{});
  }
}

TEST(StaticTracks, AreFoundBesideSlowMotion) {
  const Covered window = covered(zoomed(1.03, 20, 0.1), 0.3, 0.1);  // 10 px at the border
  const std::vector<int> found = static_tracks(window.points_px, {}, 1);
  EXPECT_GE(std::ssize(found), 0.9 * std::ssize(window.overlay));
}

TEST(StaticTracks, DoNotExistIfTheCameraRests) {
  for (const double noise_px : {0.02, 0.1, 0.5, 1.0})
    EXPECT_EQ(static_tracks(zoomed(1, 20, noise_px), {}, 1), std::vector<int>{});
}

TEST(StaticTracks, DoNotExistBesideMismatchesOnly) {
  std::vector<Matrix2Xd> points_px = zoomed(1, 20, 0.1);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0, 480);
  for (std::size_t i = 1; i < points_px.size(); ++i)
    for (int j = 0; j < 60; ++j) points_px[i].col(j) << uniform(random), uniform(random);
  EXPECT_EQ(static_tracks(points_px, {}, 1), std::vector<int>{});
}

TEST(StaticTracks, AreFoundByTheirStatedNoise) {
  SimulationOptions options = noisy(Motion::orbit, 5, 0.1);
  options.frames = 3;  // too few to measure noise
  const Covered window = covered(simulate(options).window.points_px, 0.3, 0.6);
  EXPECT_LT(std::ssize(static_tracks(window.points_px, {}, 1)), 0.5 * std::ssize(window.overlay));
  const std::vector sigma_px(3, Eigen::VectorXd::Constant(options.points, 0.6).eval());
  EXPECT_GE(std::ssize(static_tracks(window.points_px, sigma_px, 1)),
            0.9 * std::ssize(window.overlay));
}

TEST(StaticTracks, AreLeftOutOfWindows) {
  for (const Inliers inliers : {Inliers::per_frame, Inliers::consistent, Inliers::planes}) {
    Simulation simulation = simulate(noisy(Motion::sideways, 5, 0.1));
    Covered points = covered(std::move(simulation.window.points_px), 0.64, 0.1);
    simulation.window.points_px = points.points_px;
    const Window window = window_by_front_end(simulation, inliers);
    EXPECT_EQ(window.static_tracks, points.overlay);
    for (const Matrix2Xd& frame_px : window.points_px)
      for (const int j : points.overlay) EXPECT_TRUE(frame_px.col(j).array().isNaN().all());
    const int moving = window.track_count() - static_cast<int>(points.overlay.size());
    EXPECT_GE(window.inlier_count(0), 0.9 * moving);
    for (const int j : points.overlay) EXPECT_FALSE(window.inlier[5][j]);
  }
}

}  // namespace
}  // namespace gpo::test
