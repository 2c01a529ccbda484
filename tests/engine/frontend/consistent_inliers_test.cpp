// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/consistent_inliers.h"

#include "engine/frontend/make_window.h"
#include "engine/geometry/statistics.h"
#include "engine/methods/initializers.h"
#include "engine/window/tracks.h"
#include "engine/window/window.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace gpo {
namespace {

using test::as_front_end_makes_it;
using test::Motion;
using test::simulate;
using test::Simulation;

constexpr std::array kMotions{
    Motion::sideways, Motion::orbit, Motion::approach, Motion::oblique, Motion::wander};

/// Of windows with 15 % of their tracks off the plane, told by front end and method alone.
struct Score {
  int on_plane = 0, off_plane = 0;
  int wrong_keeps = 0, wrong_rejections = 0;
  std::vector<double> oracle_deg, per_frame_deg, consistent_deg;  ///< errors of GPO's normal
};

double normal_error_deg(const Window& window, const Simulation& truth) {
  const Initialization result = initialize_gpo(window, {}, {});
  EXPECT_TRUE(result.ok) << result.reason;
  return result.ok ? angle_deg(result.plane.normal, truth.plane.normal) : 180;
}

/// Twenty seeds of each of the five motions: 100 windows.
Score score(double travel, double noise_px) {
  Score score;
  for (const Motion motion : kMotions) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Simulation s = simulate({.motion = motion,
                                     .noise_px = noise_px,
                                     .travel = travel,
                                     .off_plane = 0.15,
                                     .seed = seed});
      const Window window = as_front_end_makes_it(s, Inliers::consistent);
      EXPECT_EQ(window.inliers, Inliers::consistent);
      for (int j = 0; j < window.track_count(); ++j) {
        const bool kept = window.is_inlier_track(j);
        (s.on_plane[j] ? score.on_plane : score.off_plane) += 1;
        score.wrong_keeps += kept && !s.on_plane[j] ? 1 : 0;
        score.wrong_rejections += !kept && s.on_plane[j] ? 1 : 0;
      }
      score.oracle_deg.push_back(normal_error_deg(s.window, s));
      score.per_frame_deg.push_back(
          normal_error_deg(as_front_end_makes_it(s, Inliers::per_frame), s));
      score.consistent_deg.push_back(normal_error_deg(window, s));
    }
  }
  return score;
}

TEST(ConsistentInliers, AreAsGoodAsAnOraclesWhereTheCameraTravels) {
  const Score s = score(0.3, 0.5);
  EXPECT_EQ(s.wrong_keeps, 0) << "of " << s.off_plane;
  EXPECT_LE(s.wrong_rejections, 0.005 * s.on_plane);
  EXPECT_LE(median(s.consistent_deg), 1.1 * median(s.oracle_deg));
}

// Four percent of the plane's distance: 15 % of the points move against the plane by few pixels.
TEST(ConsistentInliers, AreAsGoodAsAnOraclesAtLowParallax) {
  const Score s = score(0.04, 0.5);
  EXPECT_LE(s.wrong_keeps, 0.03 * s.off_plane) << "of " << s.off_plane;
  EXPECT_LE(s.wrong_rejections, 0.005 * s.on_plane);
  EXPECT_LE(median(s.consistent_deg), 1.1 * median(s.oracle_deg));
  EXPECT_GE(median(s.per_frame_deg), 2.5 * median(s.oracle_deg));  // what they are good for
}

TEST(ConsistentInliers, UseThatPreciseTracksTellMore) {
  const Score s = score(0.04, 0.1);
  EXPECT_EQ(s.wrong_keeps, 0) << "of " << s.off_plane;
  EXPECT_LE(s.wrong_rejections, 0.005 * s.on_plane);
  EXPECT_LE(median(s.consistent_deg), 1.1 * median(s.oracle_deg));
}

/// The same tracks backwards, as they were, track 0 first.
Simulation reversed(Simulation s) {
  for (auto& points : s.window.points_px) points = points.rowwise().reverse().eval();
  return s;
}

TEST(ConsistentInliers, AreTheSameInEveryRunAndOrderOfTracks) {
  for (const Motion motion : kMotions) {
    const Simulation s = simulate({.motion = motion, .travel = 0.1, .off_plane = 0.15, .seed = 3});
    const Window once = as_front_end_makes_it(s, Inliers::consistent);
    EXPECT_EQ(as_front_end_makes_it(s, Inliers::consistent).inlier, once.inlier);
    // RANSAC draws other samples then; what is consistent does not depend on them.
    Window backwards = as_front_end_makes_it(reversed(s), Inliers::consistent);
    for (auto& inlier : backwards.inlier) std::reverse(inlier.begin(), inlier.end());
    EXPECT_EQ(backwards.inlier, once.inlier);
    for (int i = 1; i < once.frame_count(); ++i)
      EXPECT_LT((backwards.H_i1[i] - once.H_i1[i]).norm(), 1e-6 * once.H_i1[i].norm());
  }
}

TEST(ConsistentInliers, KeepEveryTrackOfAnExactWindow) {
  const Simulation s = simulate({.noise_px = 0});
  const Window window = as_front_end_makes_it(s, Inliers::consistent);
  EXPECT_EQ(window.inlier_count(0), window.track_count());
  EXPECT_EQ(window.inlier_count(29), window.track_count());
  for (int i = 0; i < window.frame_count(); ++i)
    EXPECT_LT((window.H_i1[i] - s.window.H_i1[i] / s.window.H_i1[i](2, 2)).norm(), 1e-6);
}

// A tenth of the frames may disagree, and a lost track is judged by the frames that saw it.
TEST(ConsistentInliers, ForgiveATrackASlipAndItsLoss) {
  Simulation s = simulate({.frames = 30, .seed = 5});
  s.window.points_px[7].col(11) += Eigen::Vector2d(30, 0);
  for (int i = 12; i < 30; ++i) s.window.points_px[i].col(12).setConstant(std::nan(""));
  for (int i = 22; i < 30; ++i) s.window.points_px[i].col(13) += Eigen::Vector2d(30, 0);
  const Window window = as_front_end_makes_it(s, Inliers::consistent);
  EXPECT_TRUE(window.inlier[6][11]);
  EXPECT_FALSE(window.inlier[7][11]);
  EXPECT_TRUE(window.inlier[11][12]);
  EXPECT_FALSE(window.inlier[12][12]);
  EXPECT_FALSE(window.inlier[6][13]);
}

// Drift that grows with the frame: the late frames' spread must not excuse off-plane tracks in the
// early ones, nor the early frames' precision condemn the drifting ones.
TEST(ConsistentInliers, JudgeDriftingTracksByTheirOwnFrame) {
  Simulation s = simulate({.noise_px = 0.1, .off_plane = 0.15, .seed = 2});
  std::mt19937_64 random(7);
  std::normal_distribution<double> drift_px(0, 0.4);
  for (int j = 0; j < s.window.track_count(); ++j) {
    const Eigen::Vector2d at_the_end_px(drift_px(random), drift_px(random));
    for (int i = 1; i < 30; ++i) s.window.points_px[i].col(j) += i / 29.0 * at_the_end_px;
  }
  const Window window = as_front_end_makes_it(s, Inliers::consistent);
  int kept = 0;
  for (int j = 0; j < window.track_count(); ++j) {
    EXPECT_FALSE(!s.on_plane[j] && window.is_inlier_track(j)) << j;
    kept += s.on_plane[j] && window.is_inlier_track(j) ? 1 : 0;
  }
  EXPECT_GE(kept, 0.9 * static_cast<double>(std::ranges::count(s.on_plane, true)));
}

TEST(ConsistentInliers, LeaveAWindowToRansacWhereTooFewAgree) {
  // Every track off the plane of the others in most frames, seven aside.
  Simulation s = simulate({.points = 40, .seed = 1});
  for (int j = 7; j < 40; ++j) {
    for (int i = 1; i < 30; ++i) {
      if ((i + j) % 5 == 0) s.window.points_px[i].col(j) += Eigen::Vector2d(40, 10 * j);
    }
  }
  const Window per_frame = as_front_end_makes_it(s, Inliers::per_frame);
  const Window window = as_front_end_makes_it(s, Inliers::consistent);
  EXPECT_EQ(window.inliers, Inliers::per_frame);
  EXPECT_EQ(window.inlier, per_frame.inlier);
  EXPECT_EQ(window.H_i1[29], per_frame.H_i1[29]);
}

TEST(ConsistentInliers, RejectNothingWithoutRansac) {
  const Simulation s = simulate({.frames = 10, .off_plane = 0.15});
  const Camera camera{640, 480, 500, 500, 319.5, 239.5, Distortion::none, {}};
  const Tracks tracks{0, std::vector<std::int64_t>(150), s.window.points_px};
  const Window window =
      make_window(tracks, camera, s.window.timestamps_ns, {.enabled = false}, Inliers::consistent);
  EXPECT_EQ(window.inlier_count(9), 150);
  EXPECT_EQ(window.inliers, Inliers::per_frame);
}

}  // namespace
}  // namespace gpo
