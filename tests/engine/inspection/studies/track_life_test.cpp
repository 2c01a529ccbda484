// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"
#include "engine/inspection/report/report.h"
#include "engine/inspection/studies/studies.h"
#include "engine/methods/common/window_checks.h"
#include "engine/planes/inliers.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/engine/simulated_window.h"
#include "tests/engine/test_folder.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <sstream>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr, testing::MatchesRegex;

constexpr int kStart = 100;

/// A simulated window of 150 tracks without distortion. The first fifth is off the plane.
struct SimulatedLife : testing::Test {
  explicit SimulatedLife(Inliers inliers = Inliers::per_frame) {
    const Simulation truth = simulate({.motion = Motion::orbit, .noise_px = 0.4, .off_plane = 0.2});
    auto recording = std::make_shared<Recording>();
    recording->camera = Camera{640, 480, 500, 500, 319.5, 239.5, Distortion::none, {}};
    *window = window_by_front_end(truth, inliers);
    window->start = tracks->start = kStart;
    tracks->raw_px = truth.window.points_px;
    tracks->ids.resize(truth.window.track_count());
    std::iota(tracks->ids.begin(), tracks->ids.end(), 1000);
    inspection.recording = recording;
    inspection.initialization =
        std::make_shared<const Initialization>(initialize_gpo(*window, {}, {}));
    inspection.window = window;
    inspection.tracks = tracks;
  }

  void hide(int track, int from) {
    for (int i = from; i < 30; ++i) {
      window->points_px[i].col(track).setConstant(std::nan(""));
      window->inlier[i][track] = false;
    }
  }

  void end_140() {
    tracks->ends.resize(150);
    tracks->ends[140] = TrackEnd{17, LossReason::forward_backward, 0.83, 0.5};
    for (int i = 17; i < 30; ++i) tracks->raw_px[i].col(140).setConstant(std::nan(""));
    hide(140, 17);
  }

  std::shared_ptr<Window> window = std::make_shared<Window>();
  std::shared_ptr<Tracks> tracks = std::make_shared<Tracks>();
  Inspection inspection;
};

struct TrackLifeTest : SimulatedLife {};

TEST_F(TrackLifeTest, HasEveryFrameWithItsErrorsAlsoForAnOutlier) {
  const TrackLife life = track_life(inspection, 140);
  EXPECT_EQ(life.id, 1140);
  EXPECT_EQ(life.column, 140);
  ASSERT_EQ(life.frames.size(), 30U);
  EXPECT_EQ(life.frames[0].frame, kStart);
  EXPECT_FALSE(life.frames[0].transfer_px);
  EXPECT_LT(*life.frames[0].residual_px, 1e-6);
  for (int i = 1; i < 30; ++i) {
    const TrackFrame& frame = life.frames[i];
    EXPECT_EQ(frame.raw_px, tracks->raw_px[i].col(140));
    EXPECT_EQ(frame.inlier, *frame.transfer_px <= 2.0);
    EXPECT_LT(*frame.residual_px, 2.5);
    EXPECT_FALSE(frame.forward_backward_px);
  }
  EXPECT_EQ(life.inlier_since, kStart + 1);
  EXPECT_EQ(life.inlier_until, kStart + 29);
  EXPECT_EQ(life.verdict, "inlier in 29 of 29 frames");
  EXPECT_GT(*life.depth, 0);
  const TrackLife outlier = track_life(inspection, 2);
  EXPECT_THAT(outlier.verdict,
              MatchesRegex("outlier in [0-9]+ of 29 frames: transfer error up to [0-9.]+ px of at "
                           "most 2 px"));
  EXPECT_GT(*outlier.frames.back().residual_px, 5);
  EXPECT_FALSE(outlier.depth);
}

TEST(TrackFrames, NameTheNumberThatDecidesFirst) {
  TrackFrame seen{.transfer_px = 1.291, .limit_px = 2, .residual_px = 4.12, .on_its_plane = true};
  EXPECT_EQ(decision_text(seen),
            "transfer error 1.29 px of at most 2 px: inlier; residual of the solution 4.12 px");
  seen.limit_px.reset();
  EXPECT_EQ(decision_text(seen),
            "transfer error 1.29 px: inlier; residual of the solution 4.12 px");
  seen.residual_px.reset();
  seen.on_its_plane = false;
  EXPECT_EQ(decision_text(seen), "transfer error 1.29 px: outlier over the window");
  seen.limit_px = 2;
  EXPECT_EQ(decision_text(seen), "transfer error 1.29 px of at most 2 px: outlier over the window");
  seen.limit_px = 1.25;
  EXPECT_EQ(decision_text(seen), "transfer error 1.29 px of at most 1.25 px: outlier");
  seen.limit_px = 1.2896;
  EXPECT_EQ(decision_text(seen), "transfer error 1.2910 px of at most 1.2896 px: outlier")
      << "two decimals would look equal";
  EXPECT_EQ(decision_text({.residual_px = 0.5}), "residual of the solution 0.50 px");
  EXPECT_EQ(decision_text({}), "");
}

/// Returns an inspection of a window by the front end; a tenth of its tracks is noisier.
Inspection selected_by(Inliers inliers, double off_plane = 0.2) {
  const Simulation truth =
      simulate({.motion = Motion::orbit, .noise_px = 0.4, .off_plane = off_plane});
  auto recording = std::make_shared<Recording>();
  recording->camera = Camera{640, 480, 500, 500, 319.5, 239.5, Distortion::none, {}};
  auto tracks = std::make_shared<Tracks>();
  tracks->raw_px = truth.window.points_px;
  tracks->ids.resize(truth.window.track_count());
  std::iota(tracks->ids.begin(), tracks->ids.end(), 0);
  Eigen::VectorXd sigma_px = Eigen::VectorXd::Constant(tracks->track_count(), 0.4);
  for (int j = 5; j < tracks->track_count(); j += 10) sigma_px[j] = 1.6;
  tracks->sigma_px.assign(tracks->raw_px.size(), sigma_px);
  Inspection inspection;
  inspection.recording = recording;
  inspection.tracks = tracks;
  inspection.settings.options.ransac = true;
  inspection.window = std::make_shared<const Window>(
      make_window(*tracks, recording->camera, truth.window.timestamps_ns, {.inliers = inliers}));
  inspection.initialization = std::make_shared<const Initialization>(failed("not computed"));
  return inspection;
}

TEST(TrackLives, HaveTheLimitThatDecided) {
  for (const Inliers inliers : {Inliers::per_frame, Inliers::consistent, Inliers::planes}) {
    SCOPED_TRACE(static_cast<int>(inliers));
    const Inspection inspection = selected_by(inliers);
    const Window& window = *inspection.window;
    ASSERT_EQ(window.inliers, inliers);
    const bool by_window = inliers == Inliers::consistent;
    int agreeing = 0, disagreeing = 0;
    for (const TrackLife& life : track_lives(inspection))
      for (const TrackFrame& seen : life.frames) {
        if (seen.frame == 0) continue;
        if (!seen.limit_px) {
          EXPECT_TRUE(inliers == Inliers::planes && !window.plane_of(life.column));
          continue;
        }
        EXPECT_EQ(*seen.limit_px > 2, life.column % 10 == 5) << "noisier tracks have wider gates";
        if (seen.on_its_plane) EXPECT_FALSE(seen.beyond_limit()) << life.id;
        if (!by_window) EXPECT_EQ(seen.on_its_plane, !seen.beyond_limit()) << life.id;
        ++(seen.beyond_limit() ? disagreeing : agreeing);
      }
    EXPECT_GT(agreeing, 3000);
    EXPECT_GT(disagreeing, inliers == Inliers::planes ? -1 : 100);
  }
}

TEST(TrackLives, HaveNoLimitWithoutRansac) {
  Inspection inspection = selected_by(Inliers::per_frame);
  inspection.settings.options.ransac = false;
  EXPECT_FALSE(track_life(inspection, 2).frames[5].limit_px);
}

TEST(TrackLives, PutTheErrorOverTheWindowFirstForATrackOnNoPlane) {
  const Inspection inspection = selected_by(Inliers::planes);
  int off = 0;
  for (const TrackLife& life : track_lives(inspection)) {
    if (inspection.window->plane_of(life.column)) continue;
    double px = 0, limit_px = 0;
    ASSERT_EQ(std::sscanf(life.verdict.c_str(),
                          "on no plane: its RMS transfer error %lf px of at most %lf px from plane "
                          "1 over the window",
                          &px,
                          &limit_px),
              2)
        << life.verdict;
    EXPECT_GT(px, limit_px);
    EXPECT_EQ(limit_px > 2.5, life.column % 10 == 5) << life.verdict;
    ++off;
  }
  EXPECT_GT(off, 20);
}

TEST_F(TrackLifeTest, AcceptsATrackOnAnotherPlane) {
  window->planes = {{{140, 141}, window->H_i1, window->inlier},
                    {{2}, window->H_i1, window->inlier}};
  for (int i = 0; i < 30; ++i) window->planes[1].inlier[i][2] = i < 20;
  EXPECT_EQ(track_life(inspection, 140).verdict, "inlier in 29 of 29 frames");
  EXPECT_THAT(track_life(inspection, 2).verdict,
              MatchesRegex("on plane 2: inlier of it in 19 of 29 frames, off the leading plane by "
                           "up to [0-9.]+ px"));
  window->leader = 1;
  EXPECT_THAT(track_life(inspection, 140).verdict,
              HasSubstr("on plane 1: inlier of it in 29 of 29"));
}

TEST_F(TrackLifeTest, MeasuresATrackOnAnotherPlaneAgainstThatPlane) {
  window->planes = {{{140, 141}, window->H_i1, window->inlier},
                    {{2}, window->H_i1, window->inlier}};
  for (auto& inlier : window->planes[1].inlier) inlier[2] = true;
  auto result = std::make_shared<Initialization>(*inspection.initialization);
  // Parallel to the main plane and as far as the track's first ray and second observation tell.
  const Eigen::Vector3d ray = window->K.inverse() * window->points_px[0].col(2).homogeneous();
  double best = 1e9;
  Plane plane = result->plane;
  for (double distance = 0.5; distance < 2; distance += 0.01) {
    result->planes = {{0, result->plane}, {1, {result->plane.normal, distance}}};
    inspection.initialization = result;
    const double rms_px = rms_residual_px(track_life(inspection, 2)).value_or(1e9);
    if (rms_px < best) plane.distance = distance;
    best = std::min(best, rms_px);
  }
  EXPECT_LT(best, 1) << "noise of 0.4 px on each coordinate, although 5 px from the main plane";
  result->planes[1].plane = plane;
  const TrackLife life = track_life(inspection, 2);
  const double depth = -plane.distance / plane.normal.dot(ray);
  EXPECT_NEAR(*life.depth, depth, 1e-9);
  EXPECT_FALSE(life.frames.back().inlier);
  EXPECT_TRUE(life.frames.back().on_its_plane);
}

TEST_F(TrackLifeTest, EndsWhereTheTrackIsLost) {
  end_140();
  tracks->forward_backward_px.assign(30, Eigen::VectorXd::Constant(150, 0.1));
  const TrackLife life = track_life(inspection, 140);
  EXPECT_EQ(life.frames.size(), 17U);
  EXPECT_EQ(life.frames[3].forward_backward_px, 0.1);
  EXPECT_EQ(life.inlier_until, kStart + 16);
  EXPECT_EQ(life.verdict,
            "inlier in 16 of 16 frames; lost in frame 117: forward-backward error 0.83 px above "
            "0.5 px");
}

TEST_F(TrackLifeTest, CountsLostTracksApart) {
  end_140();
  tracks->ends.clear();
  EXPECT_EQ(track_life(inspection, 140).verdict, "inlier in 16 of 16 frames; lost in frame 117")
      << "tracks from a file have no reason";
  EXPECT_FALSE(is_lost(*window, 16, 140));
  EXPECT_TRUE(is_lost(*window, 17, 140));
  EXPECT_EQ(lost_count(*window, 16), 0);
  EXPECT_EQ(lost_count(*window, 29), 1);
  EXPECT_EQ(inliers_note(inspection), "tracks, 1 lost");
  hide(141, 0);
  inspection.settings.exclude = {1141};
  EXPECT_EQ(lost_count(*window, 29), 1) << "an excluded track is not lost";
  const auto json = to_json(inspection);
  EXPECT_EQ(json["window"]["lost"], 1);
  EXPECT_EQ(json["frames"][16]["lost"], 0);
  EXPECT_EQ(json["frames"][17]["lost"], 1);
  EXPECT_THAT(to_text(inspection), HasSubstr(" of 149 tracks, 1 lost\n"));
  end_140();
  inspection.settings.exclude = {1140};
  EXPECT_EQ(track_life(inspection, 140).verdict, "excluded");
}

TEST_F(TrackLifeTest, KeepsTheErrorsOfAnExcludedTrack) {
  const TrackLife before = track_life(inspection, 140);
  hide(140, 0);
  inspection.settings.exclude = {1140};
  const TrackLife life = track_life(inspection, 140);
  EXPECT_EQ(life.verdict, "excluded");
  ASSERT_EQ(life.frames.size(), 30U);
  EXPECT_EQ(life.frames[9].transfer_px, before.frames[9].transfer_px);
  EXPECT_EQ(life.frames[9].residual_px, before.frames[9].residual_px);
}

TEST_F(TrackLifeTest, HasNoResidualsOrDepthAfterAFailure) {
  inspection.initialization = std::make_shared<const Initialization>(failed("no parallax"));
  const TrackLife life = track_life(inspection, 140);
  EXPECT_FALSE(life.depth);
  EXPECT_FALSE(life.frames[5].residual_px);
  EXPECT_TRUE(life.frames[5].transfer_px);
  EXPECT_TRUE(residuals_px(inspection, 5).empty());
}

TEST_F(TrackLifeTest, HasResidualsOfTheResultsRms) {
  std::vector<double> all;
  for (int i = 1; i < 30; ++i) {
    const std::vector<double> residuals = residuals_px(inspection, i);
    EXPECT_EQ(static_cast<int>(residuals.size()), window->inlier_count(i));
    all.insert(all.end(), residuals.begin(), residuals.end());
  }
  EXPECT_NEAR(root_mean_square(all), inspection.initialization->rms_px, 1e-9);
}

/// The same with consistent inliers.
struct TracksTable : SimulatedLife {
  TracksTable() : SimulatedLife(Inliers::consistent) { end_140(); }

  /// Returns the row of a track in a frame, without frame and track.
  std::string row_of(int frame, int track) const {
    const std::string begin = std::to_string(frame) + "," + std::to_string(track) + ",";
    std::istringstream lines(tracks_csv(inspection));
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with(begin)) return line.substr(begin.size());
    return "";
  }
};

TEST_F(TracksTable, ReportsTheAgreementOfAnInconsistentTrack) {
  ASSERT_EQ(window->inliers, Inliers::consistent);
  const TrackLife life = track_life(inspection, 2);
  EXPECT_FALSE(life.inlier_since);
  EXPECT_THAT(life.verdict, HasSubstr("inconsistent: agrees with the plane in "));
  EXPECT_THAT(life.verdict, HasSubstr(" of 29 frames, 90 % are needed"));
}

TEST_F(TracksTable, CanBeReadBack) {
  const TestFolder folder;
  const auto read = read_tracks(folder.write("tracks.csv", tracks_csv(inspection)), std::nullopt);
  const Tracks again = select_tracks(read, kStart, tracks->frame_count());
  ASSERT_EQ(again.ids, tracks->ids);
  for (int i = 0; i < tracks->frame_count(); ++i)
    for (int j = 0; j < tracks->track_count(); ++j) {
      ASSERT_EQ(again.seen(i, j), tracks->seen(i, j));
      if (!tracks->seen(i, j)) continue;
      ASSERT_EQ(again.raw_px[i].col(j), tracks->raw_px[i].col(j));
    }
}

TEST_F(TracksTable, HasThePlaneOfATrackAndReportsWhyItIsAnOutlierOrLost) {
  EXPECT_THAT(row_of(110, 1139), HasSubstr(",inlier,"));
  EXPECT_THAT(row_of(110, 1140), testing::EndsWith(","));
  EXPECT_THAT(row_of(116, 1140),
              testing::EndsWith("lost in frame 117: forward-backward error 0.83 px above 0.5 px"));
  EXPECT_EQ(row_of(117, 1140), "");
  EXPECT_THAT(row_of(100, 1002), HasSubstr(",outlier,"));
  EXPECT_THAT(row_of(129, 1002), HasSubstr("transfer error "));
  EXPECT_EQ(std::ranges::count(row_of(100, 1002), ','), 5)
      << "commas of a sentence would separate cells";
  window->planes.resize(2);
  for (WindowPlane& plane : window->planes) {
    plane.H_i1 = window->H_i1;
    plane.inlier = window->inlier;
  }
  window->planes[0].tracks = {139};
  window->planes[1].tracks = {2, 5};
  EXPECT_THAT(row_of(110, 1139), HasSubstr(",1,inlier,"));
  EXPECT_THAT(row_of(110, 1002), HasSubstr(",2,outlier,"));
  EXPECT_THAT(row_of(110, 1003), HasSubstr(",,outlier,"));
}

}  // namespace
}  // namespace gpo::test
