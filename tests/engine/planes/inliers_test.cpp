// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/planes/inliers.h"

#include "engine/geometry/homography.h"
#include "engine/geometry/statistics.h"
#include "engine/methods/initializers.h"
#include "tests/engine/simulated_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using Eigen::Matrix3d;

struct MatchedPairs {
  Eigen::Matrix2Xd from, to;
};

/// 120 pairs, the first ones moved by a homography with half a pixel of noise, the others some
/// pixels farther. With some seeds a few pairs are chessboard corners, so samples are collinear.
MatchedPairs simulated_pairs(int with_homography, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> x(0, 640);
  std::normal_distribution<double> noise(0, 1);
  Matrix3d H;
  H << 1.05, 0.03, 10, -0.02, 0.97, -5, 1e-4, -5e-5, 1;
  MatchedPairs pairs{Eigen::Matrix2Xd(2, 120), Eigen::Matrix2Xd(2, 120)};
  for (int j = 0; j < 120; ++j) {
    pairs.from.col(j) << x(random), 0.75 * x(random);
    if (j < static_cast<int>(seed % 4) * 8) pairs.from.col(j) << 20.0 * (j % 8), 20.0 * (j % 3);
    const double sigma_px = j < with_homography ? 0.5 : 10;
    pairs.to.col(j) =
        transfer(H, pairs.from.col(j)) + sigma_px * Eigen::Vector2d(noise(random), noise(random));
  }
  return pairs;
}

std::vector<int> agreeing_with(const Matrix3d& H, const MatchedPairs& pairs, double threshold_px) {
  std::vector<int> inliers;
  for (int j = 0; j < pairs.from.cols(); ++j) {
    const bool in_front = (H * pairs.from.col(j).homogeneous()).z() * H(2, 2) > 0;
    const double error_px = (transfer(H, pairs.from.col(j)) - pairs.to.col(j)).norm();
    if (in_front && error_px <= threshold_px) inliers.push_back(j);
  }
  return inliers;
}

/// The best sample's inliers, with every sample fitted and judged in full.
std::vector<int> plain_ransac(const MatchedPairs& pairs, const RansacOptions& options) {
  std::mt19937_64 random(options.seed);
  std::vector<int> best;
  double needed = options.most_iterations;
  const auto n = static_cast<std::uint64_t>(pairs.from.cols());
  for (int iteration = 0; iteration < needed; ++iteration) {
    std::array<int, 4> four{};
    for (int k = 0; k < 4;) {
      four[k] = static_cast<int>(random() % n);
      if (std::find(four.begin(), four.begin() + k, four[k]) == four.begin() + k) ++k;
    }
    const auto H = fit_homography(pairs.from(Eigen::all, four), pairs.to(Eigen::all, four));
    if (!H) continue;
    std::vector<int> inliers = agreeing_with(*H, pairs, kUsualThreshold);
    if (inliers.size() <= best.size()) continue;
    best = std::move(inliers);
    const double ratio = static_cast<double>(best.size()) / static_cast<double>(n);
    const double wanted = std::log(1 - options.confidence) / std::log1p(-std::pow(ratio, 4));
    needed = std::min<double>(options.most_iterations, std::ceil(wanted));
  }
  return best;
}

TEST(HomographyRansac, MatchesPlainRansac) {
  for (const int with_homography : {114, 60, 36, 24})
    for (unsigned seed = 1; seed <= 12; ++seed) {
      SCOPED_TRACE(testing::Message() << with_homography << " seed " << seed);
      const MatchedPairs pairs = simulated_pairs(with_homography, seed);
      const RansacOptions options;
      const auto robust = homography_ransac(pairs.from, pairs.to, options);
      ASSERT_TRUE(robust);
      std::vector<int> inliers = plain_ransac(pairs, options);
      const auto H = fit_homography(pairs.from(Eigen::all, inliers), pairs.to(Eigen::all, inliers));
      ASSERT_TRUE(H);
      Matrix3d refined = *H;
      for (int round = 0; round < 3; ++round) {
        refined = refine_homography(
            refined, pairs.from(Eigen::all, inliers), pairs.to(Eigen::all, inliers));
        inliers = agreeing_with(refined, pairs, kUsualThreshold);
      }
      std::vector<bool> expected(120, false);
      for (const int j : inliers) expected[j] = true;
      EXPECT_EQ(robust->inlier, expected);
      EXPECT_LT((robust->H - refined).norm(), 1e-6);
    }
}

constexpr std::array kFiveMotions{
    Motion::sideways, Motion::orbit, Motion::approach, Motion::oblique, Motion::wander};

/// Result of windows with 15 % of their tracks off the plane.
struct Score {
  int on_plane = 0, off_plane = 0;
  int wrong_inliers = 0, wrong_rejections = 0;
  std::vector<double> oracle_deg, per_frame_deg, consistent_deg;  ///< errors of GPO's normal
};

double normal_error_deg(const Window& window, const Simulation& truth) {
  const Initialization result = initialize_gpo(window, {}, {});
  EXPECT_TRUE(result.ok) << result.reason;
  return result.ok ? angle_deg(result.plane.normal, truth.plane.normal) : 180;
}

Score score(double travel, double noise_px) {
  Score score;
  for (const Motion motion : kFiveMotions)
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Simulation s = simulate({.motion = motion,
                                     .noise_px = noise_px,
                                     .travel = travel,
                                     .off_plane = 0.15,
                                     .seed = seed});
      const Window window = window_by_front_end(s, Inliers::consistent);
      EXPECT_EQ(window.inliers, Inliers::consistent);
      for (int j = 0; j < window.track_count(); ++j) {
        const bool inlier = window.is_inlier_track(j);
        (s.on_plane[j] ? score.on_plane : score.off_plane) += 1;
        score.wrong_inliers += inlier && !s.on_plane[j] ? 1 : 0;
        score.wrong_rejections += !inlier && s.on_plane[j] ? 1 : 0;
      }
      score.oracle_deg.push_back(normal_error_deg(s.window, s));
      score.per_frame_deg.push_back(
          normal_error_deg(window_by_front_end(s, Inliers::per_frame), s));
      score.consistent_deg.push_back(normal_error_deg(window, s));
    }
  return score;
}

// At a travel of four percent of the plane's distance, 15 % of the points move against the plane by
// few pixels. There inliers by frame are far worse.
TEST(ConsistentInliers, MatchAnOracle) {
  struct Case {
    double travel, noise_px, most_wrong_share;
  };
  for (const auto& [travel, noise_px, most_wrong_share] :
       {Case{0.3, 0.5, 0}, {0.04, 0.5, 0.03}, {0.04, 0.1, 0}}) {
    SCOPED_TRACE(testing::Message() << "travel " << travel << ", noise " << noise_px << " px");
    const Score s = score(travel, noise_px);
    EXPECT_LE(s.wrong_inliers, most_wrong_share * s.off_plane) << "of " << s.off_plane;
    EXPECT_LE(s.wrong_rejections, 0.005 * s.on_plane);
    EXPECT_LE(median(s.consistent_deg), 1.1 * median(s.oracle_deg));
    if (most_wrong_share > 0) {
      EXPECT_GE(median(s.per_frame_deg), 2.5 * median(s.oracle_deg));
    }
  }
}

TEST(ConsistentInliers, DoNotDependOnRunOrOrderOfTracks) {
  for (const Motion motion : kFiveMotions) {
    Simulation s = simulate({.motion = motion, .travel = 0.1, .off_plane = 0.15, .seed = 3});
    const Window once = window_by_front_end(s, Inliers::consistent);
    EXPECT_EQ(window_by_front_end(s, Inliers::consistent).inlier, once.inlier);
    // RANSAC draws other samples in the reversed order; consistent inliers do not depend on them.
    for (auto& points : s.window.points_px) points = points.rowwise().reverse().eval();
    Window backwards = window_by_front_end(s, Inliers::consistent);
    for (auto& inlier : backwards.inlier) std::reverse(inlier.begin(), inlier.end());
    EXPECT_EQ(backwards.inlier, once.inlier);
    for (int i = 1; i < once.frame_count(); ++i)
      EXPECT_LT((backwards.H_i1[i] - once.H_i1[i]).norm(), 1e-6 * once.H_i1[i].norm());
  }
}

TEST(ConsistentInliers, AreAllTracksOfAnExactWindow) {
  const Simulation s = simulate({.noise_px = 0});
  const Window window = window_by_front_end(s, Inliers::consistent);
  EXPECT_EQ(window.inlier_count(0), window.track_count());
  EXPECT_EQ(window.inlier_count(29), window.track_count());
  for (int i = 0; i < window.frame_count(); ++i)
    EXPECT_LT((window.H_i1[i] - s.window.H_i1[i] / s.window.H_i1[i](2, 2)).norm(), 1e-6);
}

// A tenth of the frames may disagree, and a lost track is judged by the frames that saw it.
TEST(ConsistentInliers, TolerateSingleFrameErrorsAndLostTracks) {
  Simulation s = simulate({.frames = 30, .seed = 5});
  s.window.points_px[7].col(11) += Eigen::Vector2d(30, 0);
  for (int i = 12; i < 30; ++i) s.window.points_px[i].col(12).setConstant(std::nan(""));
  for (int i = 22; i < 30; ++i) s.window.points_px[i].col(13) += Eigen::Vector2d(30, 0);
  const Window window = window_by_front_end(s, Inliers::consistent);
  EXPECT_TRUE(window.inlier[6][11]);
  EXPECT_FALSE(window.inlier[7][11]);
  EXPECT_TRUE(window.inlier[11][12]);
  EXPECT_FALSE(window.inlier[12][12]);
  EXPECT_FALSE(window.inlier[6][13]);
}

// Drift grows with the frame. The spread of late frames must not accept off-plane tracks in early
// ones, and the precision of early frames must not reject drifting tracks.
TEST(ConsistentInliers, JudgeDriftingTracksByTheirOwnFrame) {
  Simulation s = simulate({.noise_px = 0.1, .off_plane = 0.15, .seed = 2});
  std::mt19937_64 random(7);
  std::normal_distribution<double> drift_px(0, 0.4);
  for (int j = 0; j < s.window.track_count(); ++j) {
    const Eigen::Vector2d at_the_end_px(drift_px(random), drift_px(random));
    for (int i = 1; i < 30; ++i) s.window.points_px[i].col(j) += i / 29.0 * at_the_end_px;
  }
  const Window window = window_by_front_end(s, Inliers::consistent);
  int accepted = 0;
  for (int j = 0; j < window.track_count(); ++j) {
    EXPECT_FALSE(!s.on_plane[j] && window.is_inlier_track(j)) << j;
    accepted += s.on_plane[j] && window.is_inlier_track(j) ? 1 : 0;
  }
  EXPECT_GE(accepted, 0.9 * static_cast<double>(std::ranges::count(s.on_plane, true)));
}

// All tracks but seven are off the plane of the others in most frames.
TEST(ConsistentInliers, FallBackToRansacIfTooFewAgree) {
  Simulation s = simulate({.points = 40, .seed = 1});
  for (int j = 7; j < 40; ++j)
    for (int i = 1; i < 30; ++i)
      if ((i + j) % 5 == 0) s.window.points_px[i].col(j) += Eigen::Vector2d(40, 10 * j);
  const Window per_frame = window_by_front_end(s, Inliers::per_frame);
  const Window window = window_by_front_end(s, Inliers::consistent);
  EXPECT_EQ(window.inliers, Inliers::per_frame);
  EXPECT_EQ(window.inlier, per_frame.inlier);
  EXPECT_EQ(window.H_i1[29], per_frame.H_i1[29]);
}

TEST(ConsistentInliers, AreAllTracksWithoutRansac) {
  const Simulation s = simulate({.frames = 10, .off_plane = 0.15});
  const Camera camera{640, 480, 500, 500, 319.5, 239.5, Distortion::none, {}};
  const Tracks tracks{0, std::vector<std::int64_t>(150), s.window.points_px};
  const InlierOptions options{.ransac = {.enabled = false}, .inliers = Inliers::consistent};
  const Window window = make_window(tracks, camera, s.window.timestamps_ns, options);
  EXPECT_EQ(window.inlier_count(9), 150);
  EXPECT_EQ(window.inliers, Inliers::per_frame);
}

// Descriptors are matched wrongly in one frame and rightly in the next. No judging frame sees
// these.
TEST(MakeWindow, ToleratesWrongMatchesInOneFrame) {
  Simulation s = simulate({.motion = Motion::orbit, .frames = 20});
  for (int j = 0; j < 12; ++j)
    s.window.points_px[4].col(10 * j) += Eigen::Vector2d(90 - 15 * j, 8 * j);
  const Window window = window_by_front_end(s, Inliers::planes);
  ASSERT_EQ(window.planes.size(), 1U);
  EXPECT_GE(window.inlier_count(4), window.inlier_count(5) - 16);
}

/// Returns the largest share of a plane's tracks that are on one true plane.
double purity(const Room& room, const std::vector<int>& tracks) {
  std::map<int, int> counts;
  for (const int j : tracks) ++counts[room.plane_of_track[j]];
  int most = 0;
  for (const auto& [plane, count] : counts)
    if (plane >= 0) most = std::max(most, count);
  return static_cast<double>(most) / static_cast<double>(tracks.size());
}

TEST(WindowPlanes, AreFloorAndWallsOfARoomDisjointAndSorted) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Room room =
        simulate_room({.planes = floor_and_walls(), .shares = {0.4, 0.25, 0.2}, .seed = seed});
    ASSERT_EQ(room.window.planes.size(), 3) << seed;
    for (const WindowPlane& plane : room.window.planes)
      EXPECT_GT(purity(room, plane.tracks), 0.85) << seed;
    EXPECT_GE(room.window.planes[0].tracks.size(), room.window.planes[1].tracks.size());
  }
  const Room room = simulate_room({.planes = floor_and_walls(), .shares = {0.4, 0.3, 0.3}});
  std::vector<int> all;
  for (const WindowPlane& plane : room.window.planes) {
    EXPECT_TRUE(std::ranges::is_sorted(plane.tracks));
    all.insert(all.end(), plane.tracks.begin(), plane.tracks.end());
  }
  std::ranges::sort(all);
  EXPECT_EQ(std::ranges::adjacent_find(all), all.end());
}

TEST(WindowPlanes, AreFoundFromAQuarterOfTheTracksButNotInACloud) {
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    const double farthest = 1.5 + 1.5 * static_cast<double>(seed) / 500;
    refused += simulate_room({.farthest = farthest, .seed = seed}).window.planes.empty() ? 1 : 0;
  }
  EXPECT_GE(refused, 475);
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    const Room room = simulate_room({.planes = floor_and_walls(), .shares = {0.25}, .seed = seed});
    found += !room.window.planes.empty() && purity(room, room.window.planes[0].tracks) > 0.8;
  }
  EXPECT_GE(found, 475);
}

TEST(WindowPlanes, SeparateTwoLayersAndJudgeATrackByTheFramesThatSeeIt) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Eigen::Vector3d m = floor_and_walls()[0];
    const Room room = simulate_room({.planes = {m, m / 1.3}, .shares = {0.55, 0.45}, .seed = seed});
    ASSERT_EQ(room.window.planes.size(), 2) << seed;
    EXPECT_GT(purity(room, room.window.planes[0].tracks), 0.95) << seed;
    EXPECT_GT(purity(room, room.window.planes[1].tracks), 0.95) << seed;
  }
  Room room = simulate_room({.planes = floor_and_walls(), .shares = {1}});
  std::vector<Eigen::Matrix2Xd> points = room.window.points_px;
  for (std::size_t i = points.size() / 2; i < points.size(); ++i)
    points[i].col(3).setConstant(std::nan(""));
  const TrackPlanes found = window_planes(points);
  ASSERT_EQ(found.planes.size(), 1);
  EXPECT_TRUE(std::ranges::binary_search(found.planes[0], 3));
}

TEST(WindowPlanes, HaveTheErrorsByWhichTheirTracksWereChosen) {
  int on = 0, off = 0;
  for (const double noise_px : {0.2, 0.4})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Room room = simulate_room({.noise_px = noise_px,
                                       .planes = floor_and_walls(),
                                       .shares = {0.45, 0.25, 0.1},
                                       .seed = seed});
      const std::vector<PlaneErrors> errors = plane_errors(room.window);
      ASSERT_EQ(errors.size(), room.window.planes.size());
      for (int k = 0; k < std::ssize(errors); ++k) {
        EXPECT_GE(errors[k].gate_px, 0.6 * room.window.threshold_px);
        EXPECT_LE(errors[k].gate_px, room.window.threshold_px);
        for (int j = 0; j < room.window.track_count(); ++j) {
          const auto plane = room.window.plane_of(j);
          if (plane && plane != k) continue;
          EXPECT_EQ(errors[k].rms_px[j] <= errors[k].gate_px, plane == k) << seed << " " << j;
          ++(plane ? on : off);
        }
      }
    }
  EXPECT_GT(on, 2000);
  EXPECT_GT(off, 300);
}

// RMS transfer errors are 1.4 px, the gate is 2 px. With 1 px of noise they are at the gate, and
// one window in eight is rejected.
TEST(WindowPlanes, AreFoundFromFewNoisyTracksOrReportTheLargestRejectedSet) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Room room = simulate_room(
        {.tracks = 36, .noise_px = 0.7, .planes = floor_and_walls(), .shares = {1}, .seed = seed});
    found += room.window.planes.empty() ? 0 : 1;
  }
  EXPECT_GE(found, 48);
  const Room room = simulate_room({.seed = 3});
  ASSERT_TRUE(room.window.planes.empty());
  EXPECT_LT(room.window.largest_refused, 100);
}

}  // namespace
}  // namespace gpo::test
