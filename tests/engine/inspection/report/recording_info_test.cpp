// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/report/report.h"
#include "engine/truth/truth.h"
#include "engine/window/gyroscope.h"
#include "tests/engine/recording/board/rendered_board.h"

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using testing::HasSubstr;

Recording tracks_recording() {
  Recording recording;
  recording.path = "some/desk";
  recording.name = "desk";
  recording.layout = "tracks";
  recording.camera = {640, 480, 500, 501, 320, 240, Distortion::equidistant, {0.1, 0, 0, 0}};
  for (const int ms : {0, 100, 200, 400, 500, 600})
    recording.timestamps_ns.push_back(1'000'000'000 + ms * 1'000'000LL);
  Gyroscope gyroscope;
  for (const int ms : {-10, 0, 10, 20, 80, 90, 100, 110, 120, 640}) {
    gyroscope.timestamps_ns.push_back(1'000'000'000 + ms * 1'000'000LL);
    gyroscope.lines.push_back(static_cast<int>(gyroscope.lines.size()) + 2);
    gyroscope.rates_rad_s.emplace_back(0, 0, 0);
  }
  recording.gyroscope = gyroscope;
  recording.truth = GroundTruth{"mocap0/data.csv", std::vector<std::optional<Pose>>(6)};
  recording.truth->poses[2] = Pose{};
  recording.plane = Plane{{0, 0, -1}, 1.25};
  recording.tracks = {{0, 7, {1, 2}}, {0, 9, {1, 2}}, {1, 7, {1, 2}}};
  recording.notes = {"no pictures: tracks are drawn on a plain background"};
  return recording;
}

TEST(RecordingInfo, HasTheMeanRateOfTimesInWholeMilliseconds) {
  Recording recording = tracks_recording();
  recording.timestamps_ns.clear();
  for (const int ms : {0, 33, 67, 100, 133, 167, 200, 267, 300})
    recording.timestamps_ns.push_back(ms * 1'000'000LL);
  recording.truth = {};
  EXPECT_NEAR(describe(recording).rate_hz, 30, 0.1);
}

TEST(RecordingInfo, CountsFindsGapsAndConvertsToJsonAndText) {
  const Recording recording = tracks_recording();
  const auto info = describe(recording);
  EXPECT_DOUBLE_EQ(info.rate_hz, 10);
  EXPECT_DOUBLE_EQ(info.duration_s, 0.6);
  ASSERT_EQ(info.gaps.size(), 1U);
  EXPECT_EQ(info.gaps[0].after, 2);
  EXPECT_DOUBLE_EQ(info.gaps[0].at_s, 0.2);
  EXPECT_DOUBLE_EQ(info.gaps[0].length_s, 0.2);
  ASSERT_TRUE(info.gyroscope);
  EXPECT_DOUBLE_EQ(info.gyroscope->rate_hz, 100);
  EXPECT_TRUE(info.gyroscope->covers_frames);
  ASSERT_EQ(info.gyroscope->gaps.size(), 2U);
  EXPECT_EQ(info.gyroscope->gaps[0].after, 5);  // line
  EXPECT_DOUBLE_EQ(info.gyroscope->gaps[1].length_s, 0.52);
  ASSERT_TRUE(info.truth);
  EXPECT_EQ(info.truth->frames, 1);
  EXPECT_EQ(info.truth->examined, 6);
  ASSERT_TRUE(info.tracks);
  EXPECT_EQ(info.tracks->tracks, 2);
  EXPECT_EQ(info.tracks->observations, 3);
  EXPECT_EQ(info.tracks->longest, 2);
  const auto json = to_json(info);
  const nlohmann::json expected = nlohmann::json::parse(R"({
    "layout": "tracks", "pictures": false, "frames": 6, "recording": "some/desk",
    "camera": {"resolution": [640, 480], "distortion_model": "equidistant"},
    "gaps": [{"after_frame": 2}], "tracks": {"count": 2}, "plane": {"normal": [0.0, 0.0, -1.0]},
    "gyroscope": {"samples": 10, "gaps": [{"after_line": 5}]},
    "ground_truth": {"source": "mocap0/data.csv"}})")
                                      .flatten();
  for (const auto& [path, value] : expected.items())
    EXPECT_EQ(json.at(nlohmann::json::json_pointer(path)), value) << path;
  EXPECT_FALSE(json.contains("board"));
  const std::string text = to_text(info);
  EXPECT_THAT(text, HasSubstr("layout        tracks, without images\n"));
  EXPECT_THAT(text, HasSubstr("frames        6, 10.00 Hz, 0.60 s\n"));
  EXPECT_THAT(text, HasSubstr("  gaps        0.200 s after frame 2 (at 0.200 s)\n"));
  EXPECT_THAT(text, HasSubstr("gyroscope     100.0 Hz, 10 samples\n"));
  EXPECT_THAT(text, HasSubstr("ground truth  mocap0/data.csv, 1 of 6 frames\n"));
  EXPECT_THAT(text, HasSubstr("board         none\n"));
  EXPECT_THAT(text, HasSubstr("notes         no pictures"));
}

TEST(RecordingInfo, SearchesTheBoardInASampleOfALongRecording) {
  Recording recording = tracks_recording();
  recording.truth.reset();
  recording.board = Board{6, 5, 0.03};
  recording.camera = {160, 120, 150, 150, 80, 60, Distortion::none, {}};
  const auto with_board = test::render_board(
      *recording.board, recording.camera, test::looking_at(*recording.board, 0.35, 10, 5));
  const auto decode = [with_board](int index) {
    cv::Mat image(120, 160, CV_8UC3, cv::Scalar::all(99));
    if (index >= 200) cv::cvtColor(with_board, image, cv::COLOR_GRAY2BGR);
    return image;
  };
  recording.timestamps_ns.clear();
  for (int i = 0; i < 400; ++i) recording.timestamps_ns.push_back(i * 10'000'000LL);
  recording.images = std::make_shared<const FrameCache>(400, decode);
  const auto info = describe(recording);
  ASSERT_TRUE(info.truth);
  EXPECT_EQ(info.truth->examined, 60);
  EXPECT_EQ(info.truth->frames, 30);
  EXPECT_THAT(to_text(info), HasSubstr("chessboard (board.yaml), 30 of 60 frames examined\n"));
  EXPECT_THAT(to_text(info), HasSubstr("  uncertainty "));
  const auto truth = to_json(info)["ground_truth"];
  EXPECT_LT(truth["rms_px"], 0.2);
  EXPECT_LT(truth["position_sigma_m"], 2e-3);
  EXPECT_LT(truth["normal_sigma_deg"], truth["rotation_sigma_deg"]);
}

}  // namespace
}  // namespace gpo
