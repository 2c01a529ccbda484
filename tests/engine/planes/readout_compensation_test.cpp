// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/planes/readout_compensation.h"

#include "engine/pipeline/pipeline.h"
#include "tests/engine/simulated_window.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

constexpr double kLateRow_s = 4e-5;

SimulationOptions hand_held(int number) {
  SimulationOptions options{.motion = kMotions[number % std::size(kMotions)]};
  options.reference_noise_px = options.noise_px;
  options.seed = 100 + number;
  return options;
}

/// Displaces the points of all frames by up to a pixel at the corners, as a wrong lens does.
void bend_lens(Window& window, int seed) {
  for (Eigen::Matrix2Xd& points : window.points_px)
    for (auto p : points.colwise()) {
      const Eigen::Vector2d q = (p - Eigen::Vector2d(319.5, 239.5)) / 400;
      p += q.squaredNorm() * (0.6 * q + 0.4 * Eigen::Vector2d(std::sin(2.5 * q.x() + seed),
                                                              std::sin(2.5 * q.y() - seed)));
    }
}

Tracks tracks_of(const Window& window) {
  Tracks tracks{0, std::vector<std::int64_t>(window.track_count()), window.points_px};
  std::iota(tracks.ids.begin(), tracks.ids.end(), 0);
  return tracks;
}

Window selected(const Window& tracked, const Camera& camera) {
  return window_of(tracks_of(tracked), camera, tracked.timestamps_ns, {});
}

const Camera kSimulatedCamera{640, 480, 500, 500, 319.5, 239.5, Distortion::none, {}};

double rms_px(const Window& window, const Window& other) {
  double sum = 0;
  for (int i = 0; i < window.frame_count(); ++i)
    sum += (window.points_px[i] - other.points_px[i]).squaredNorm();
  return std::sqrt(sum / (window.frame_count() * window.track_count()));
}

TEST(WithoutReadout, RestoresPointsOfGlobalShutter) {
  SimulationOptions options{.motion = Motion::arc, .noise_px = 0, .travel = 0.8};
  const Window global = simulate(options).window;
  options.row_delay_s = kLateRow_s;
  Window rolling = simulate(options).window;
  EXPECT_GT(rms_px(rolling, global), 1);
  rolling.points_px = without_readout(rolling, rolling.points_px, kLateRow_s);
  EXPECT_LT(rms_px(rolling, global), 0.15);
}

TEST(WithoutReadout, KeepsUnseenAndLonelyPoints) {
  Window window = simulate({.frames = 10, .points = 20}).window;
  for (int i = 0; i < 10; ++i)
    if (i != 4) window.points_px[i].col(7).setConstant(std::nan(""));
  const auto points_px = without_readout(window, window.points_px, kLateRow_s);
  EXPECT_EQ(points_px[4].col(7), window.points_px[4].col(7));
  EXPECT_TRUE(points_px[5].col(7).array().isNaN().all());
}

TEST(VisibleRowDelay, IsZeroForGlobalShutterAndLensResiduals) {
  int found = 0;
  for (int number = 0; number < 200; ++number) {
    SimulationOptions options = hand_held(number);
    options.noise_px = options.reference_noise_px = 0.25 * (1 + number % 4);
    Window window = simulate(options).window;
    if (number % 2 == 0) bend_lens(window, number);
    found += selected(window, kSimulatedCamera).selection_row_delay_s != 0 ? 1 : 0;
  }
  EXPECT_LE(found, 4);
}

TEST(VisibleRowDelay, IsNearTruthWithoutMuchNoise) {
  int near = 0, visible = 0;
  for (int number = 0; number < 32; ++number) {
    SimulationOptions options = hand_held(number);
    options.noise_px = options.reference_noise_px = 0.1;
    options.row_delay_s = number % 2 == 0 ? kLateRow_s : -kLateRow_s;
    const double found_s =
        selected(simulate(options).window, kSimulatedCamera).selection_row_delay_s;
    visible += found_s != 0 ? 1 : 0;
    near += std::abs(found_s - options.row_delay_s) < 0.2 * kLateRow_s ? 1 : 0;
  }
  EXPECT_GE(visible, 28);
  EXPECT_GE(near, 0.9 * visible);
}

TEST(RollingShutter, LeavesRotationsFromImages) {
  int solved = 0;
  for (int number = 0; number < 40; ++number) {
    SimulationOptions options = hand_held(number);
    options.row_delay_s = kLateRow_s;
    options.travel = 0.8;
    const Window window = selected(simulate(options).window, kSimulatedCamera);
    const ChosenRotations chosen = chosen_rotations(window, {}, RotationSource::automatic, {});
    solved += chosen.rotations.R_wc.empty() ? 0 : 1;
  }
  EXPECT_GE(solved, 38);
}

TEST(KnownReadout, CompensatesWithoutEstimate) {
  SimulationOptions options = hand_held(0);
  options.row_delay_s = kLateRow_s;
  Camera camera = kSimulatedCamera;
  camera.readout = readout_of(479 * kLateRow_s);
  const Window tracked = simulate(options).window;
  const Window window = selected(tracked, camera);
  EXPECT_NEAR(window.selection_row_delay_s, kLateRow_s, 1e-11);
  EXPECT_EQ(rms_px(window, tracked), 0);
}

}  // namespace
}  // namespace gpo::test
