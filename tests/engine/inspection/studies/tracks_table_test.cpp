// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/tracks_table.h"

#include "engine/methods/initializers.h"
#include "engine/recording/layouts/layouts.h"
#include "engine/window/tracks.h"
#include "engine/window/window.h"
#include "tests/engine/simulated_window.h"
#include "tests/engine/test_folder.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::HasSubstr;

constexpr int kFirstFrame = 100;

/// A fifth of its tracks, the first ones, are off the plane; track 1140 is lost in frame 117.
Inspection tabled() {
  const test::Simulation truth =
      test::simulate({.motion = test::Motion::orbit, .noise_px = 0.4, .off_plane = 0.2});
  auto recording = std::make_shared<Recording>();
  recording->camera = Camera{640, 480, 500, 500, 319.5, 239.5, Distortion::none, {}};
  auto window = std::make_shared<Window>(test::as_front_end_makes_it(truth, Inliers::consistent));
  window->start = kFirstFrame;
  auto tracks = std::make_shared<Tracks>();
  tracks->start = kFirstFrame;
  tracks->raw_px = truth.window.points_px;
  tracks->ids.resize(truth.window.track_count());
  std::iota(tracks->ids.begin(), tracks->ids.end(), 1000);
  tracks->ends.resize(tracks->ids.size());
  tracks->ends[140] = TrackEnd{17, LossReason::forward_backward, 0.83, 0.5};
  for (int i = 17; i < 30; ++i) {
    tracks->raw_px[i].col(140).setConstant(std::nan(""));
    window->points_px[i].col(140).setConstant(std::nan(""));
    window->inlier[i][140] = false;
  }
  Inspection inspection;
  inspection.recording = recording;
  inspection.initialization =
      std::make_shared<const Initialization>(initialize_gpo(*window, {}, {}));
  inspection.window = window;
  inspection.tracks = tracks;
  return inspection;
}

/// The row of a track in a frame, without frame and track.
std::string row_of(const std::string& csv, int frame, int track) {
  const std::string begin = std::to_string(frame) + "," + std::to_string(track) + ",";
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(begin)) return line.substr(begin.size());
  return "";
}

TEST(TracksTable, IsReadBackAsTheSameTracks) {
  const Inspection inspection = tabled();
  const test::TestFolder folder;
  const auto read = read_tracks(folder.write("tracks.csv", tracks_csv(inspection)), std::nullopt);
  const Tracks& tracks = *inspection.tracks;
  const Tracks again = select_tracks(read, kFirstFrame, tracks.frame_count());
  ASSERT_EQ(again.ids, tracks.ids);
  for (int i = 0; i < tracks.frame_count(); ++i) {
    for (int j = 0; j < tracks.track_count(); ++j) {
      ASSERT_EQ(again.seen(i, j), tracks.seen(i, j));
      if (!tracks.seen(i, j)) continue;
      ASSERT_EQ(again.raw_px[i].col(j), tracks.raw_px[i].col(j));
    }
  }
}

TEST(TracksTable, SaysWhyATrackIsNoInlierAndWhereItWasLost) {
  const std::string csv = tracks_csv(tabled());
  EXPECT_THAT(row_of(csv, 110, 1139), HasSubstr(",inlier,"));
  EXPECT_THAT(row_of(csv, 110, 1140), testing::EndsWith(","));
  EXPECT_THAT(row_of(csv, 116, 1140),
              testing::EndsWith("lost in frame 117: forward-backward error 0.83 px above 0.5 px"));
  EXPECT_EQ(row_of(csv, 117, 1140), "");
  EXPECT_THAT(row_of(csv, 100, 1002), HasSubstr(",outlier,"));
  EXPECT_THAT(row_of(csv, 129, 1002), HasSubstr("transfer error "));
  EXPECT_EQ(std::ranges::count(row_of(csv, 100, 1002), ','), 5)
      << "a sentence's own commas would be cells";
}

TEST(TracksTable, HasThePlaneOfATrack) {
  Inspection inspection = tabled();
  auto window = std::make_shared<Window>(*inspection.window);
  window->planes.resize(2);
  for (WindowPlane& plane : window->planes) plane.inlier = window->inlier;
  window->planes[0].tracks = {139};
  window->planes[1].tracks = {2, 5};
  inspection.window = window;
  const std::string csv = tracks_csv(inspection);
  EXPECT_THAT(row_of(csv, 110, 1139), HasSubstr(",1,inlier,"));
  EXPECT_THAT(row_of(csv, 110, 1002), HasSubstr(",2,outlier,"));
  EXPECT_THAT(row_of(csv, 110, 1003), HasSubstr(",,outlier,"));
}

}  // namespace
}  // namespace gpo
