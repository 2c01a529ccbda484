// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/track_life.h"

#include "engine/geometry/statistics.h"
#include "engine/inspection/studies/residuals.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/initializers.h"
#include "engine/window/tracks.h"
#include "engine/window/window.h"
#include "tests/engine/simulated_window.h"

#include <cmath>
#include <numeric>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

constexpr int kStart = 100;

/// Of a simulated window with a fifth of its tracks off the plane, the first ones; no distortion.
Inspection made(Inliers inliers = Inliers::per_frame) {
  const test::Simulation truth =
      test::simulate({.motion = test::Motion::orbit, .noise_px = 0.4, .off_plane = 0.2});
  auto recording = std::make_shared<Recording>();
  recording->camera = Camera{640, 480, 500, 500, 319.5, 239.5, Distortion::none, {}};
  auto window = std::make_shared<Window>(test::as_front_end_makes_it(truth, inliers));
  window->start = kStart;
  auto tracks = std::make_shared<Tracks>();
  tracks->start = kStart;
  tracks->raw_px = truth.window.points_px;
  tracks->ids.resize(truth.window.track_count());
  std::iota(tracks->ids.begin(), tracks->ids.end(), 1000);
  Inspection inspection;
  inspection.recording = recording;
  inspection.initialization =
      std::make_shared<const Initialization>(initialize_gpo(*window, {}, {}));
  inspection.window = window;
  inspection.tracks = tracks;
  return inspection;
}

TEST(TrackLife, HasEveryFrameOfATrackWithItsErrors) {
  const Inspection inspection = made();
  const TrackLife life = track_life(inspection, 140);
  EXPECT_EQ(life.id, 1140);
  EXPECT_EQ(life.column, 140);
  ASSERT_EQ(life.frames.size(), 30U);
  EXPECT_EQ(life.frames[0].frame, kStart);
  EXPECT_FALSE(life.frames[0].transfer_px);
  EXPECT_LT(*life.frames[0].residual_px, 1e-6);
  for (int i = 1; i < 30; ++i) {
    const TrackFrame& frame = life.frames[i];
    EXPECT_EQ(frame.raw_px, inspection.tracks->raw_px[i].col(140));
    EXPECT_EQ(frame.inlier, *frame.transfer_px <= 2.0);
    EXPECT_LT(*frame.residual_px, 2.5);
    EXPECT_FALSE(frame.forward_backward_px);
  }
  EXPECT_EQ(life.inlier_since, kStart + 1);
  EXPECT_EQ(life.inlier_until, kStart + 29);
  EXPECT_EQ(life.verdict, "inlier in 29 of 29 frames");
  EXPECT_GT(*life.depth, 0);
}

TEST(TrackLife, OfAnOutlierSaysByHowMuch) {
  const Inspection inspection = made();
  const TrackLife life = track_life(inspection, 2);
  EXPECT_THAT(life.verdict,
              MatchesRegex("outlier in [0-9]+ of 29 frames: transfer error up to [0-9.]+ px above "
                           "2.0 px"));
  EXPECT_GT(*life.frames.back().residual_px, 5);
  EXPECT_FALSE(life.depth);
}

TEST(TrackLife, OfAnInconsistentTrackSaysHowManyFramesAgree) {
  const Inspection inspection = made(Inliers::consistent);
  ASSERT_EQ(inspection.window->inliers, Inliers::consistent);
  const TrackLife life = track_life(inspection, 2);
  EXPECT_FALSE(life.inlier_since);
  EXPECT_THAT(life.verdict, HasSubstr("inconsistent: agrees with the plane in "));
  EXPECT_THAT(life.verdict, HasSubstr(" of 29 frames, 90 % are needed"));
}

TEST(TrackLife, OfATrackOnAnotherPlaneIsNoOutliers) {
  Inspection inspection = made();
  auto window = std::make_shared<Window>(*inspection.window);
  window->planes = {{{140, 141}, window->H_i1, window->inlier},
                    {{2}, window->H_i1, window->inlier}};
  for (int i = 0; i < 20; ++i) window->planes[1].inlier[i][2] = true;
  for (int i = 20; i < 30; ++i) window->planes[1].inlier[i][2] = false;
  inspection.window = window;
  EXPECT_EQ(track_life(inspection, 140).verdict, "inlier in 29 of 29 frames");
  EXPECT_THAT(track_life(inspection, 2).verdict,
              MatchesRegex("on plane 2: inlier of it in 19 of 29 frames, off the leading plane by "
                           "up to [0-9.]+ px"));
  window->leader = 1;
  EXPECT_THAT(track_life(inspection, 140).verdict,
              HasSubstr("on plane 1: inlier of it in 29 of 29"));
}

TEST(TrackLife, EndsWhereTheFrontEndLostIt) {
  Inspection inspection = made();
  auto tracks = std::make_shared<Tracks>(*inspection.tracks);
  auto window = std::make_shared<Window>(*inspection.window);
  tracks->ends.resize(150);
  tracks->ends[140] = TrackEnd{17, LossReason::forward_backward, 0.83, 0.5};
  tracks->forward_backward_px.assign(30, Eigen::VectorXd::Constant(150, 0.1));
  for (int i = 17; i < 30; ++i) {
    tracks->raw_px[i].col(140).setConstant(std::nan(""));
    window->points_px[i].col(140).setConstant(std::nan(""));
    window->inlier[i][140] = false;
  }
  inspection.tracks = tracks;
  inspection.window = window;
  const TrackLife life = track_life(inspection, 140);
  EXPECT_EQ(life.frames.size(), 17U);
  EXPECT_EQ(life.frames[3].forward_backward_px, 0.1);
  EXPECT_EQ(life.inlier_until, kStart + 16);
  EXPECT_EQ(life.verdict,
            "inlier in 16 of 16 frames; lost in frame 117: forward-backward error 0.83 px above "
            "0.5 px");
}

TEST(TrackLife, OfATrackLeftOutByHandIsAsItWasSeen) {
  Inspection inspection = made();
  const TrackLife before = track_life(inspection, 140);
  auto window = std::make_shared<Window>(*inspection.window);
  for (int i = 0; i < 30; ++i) {
    window->points_px[i].col(140).setConstant(std::nan(""));
    window->inlier[i][140] = false;
  }
  inspection.window = window;
  inspection.settings.exclude = {1140};
  const TrackLife life = track_life(inspection, 140);
  EXPECT_EQ(life.verdict, "left out by hand");
  ASSERT_EQ(life.frames.size(), 30U);
  EXPECT_EQ(life.frames[9].transfer_px, before.frames[9].transfer_px);
  EXPECT_EQ(life.frames[9].residual_px, before.frames[9].residual_px);
}

TEST(TrackLife, OfAFailedInitializationHasNoResidualsNorDepth) {
  Inspection inspection = made();
  inspection.initialization = std::make_shared<const Initialization>(failed("no parallax"));
  const TrackLife life = track_life(inspection, 140);
  EXPECT_FALSE(life.depth);
  EXPECT_FALSE(life.frames[5].residual_px);
  EXPECT_TRUE(life.frames[5].transfer_px);
  EXPECT_TRUE(residuals_px(inspection, 5).empty());
}

TEST(Residuals, AreTheErrorsThatTheResultTells) {
  const Inspection inspection = made();
  std::vector<double> all;
  for (int i = 1; i < 30; ++i) {
    const std::vector<double> residuals = residuals_px(inspection, i);
    EXPECT_EQ(static_cast<int>(residuals.size()), inspection.window->inlier_count(i));
    all.insert(all.end(), residuals.begin(), residuals.end());
  }
  EXPECT_NEAR(root_mean_square(all), inspection.initialization->rms_px, 1e-9);
}

}  // namespace
}  // namespace gpo
