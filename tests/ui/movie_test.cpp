// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/images/decoders.h"
#include "tests/engine/test_folder.h"
#include "tests/ui/window_test.h"
#include "ui/workbench_host.h"

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;
using test::TestFolder;

std::vector<cv::Mat> frames_of(const fs::path& file) {
  VideoDecoder video(file);
  std::vector<cv::Mat> frames;
  for (int i = 0; i < std::ssize(video.index().times); ++i) frames.push_back(video.decode(i));
  return frames;
}

double mean_difference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total() * a.channels());
}

/// A workbench with an inspection.
class MovieTest : public DrawingTest {
 protected:
  MovieTest() {
    host_.state.requests.open = "made";
    host_.timings = false;
    host_.settle();
  }
  static Worker::Opened open() {
    static const auto made = std::make_shared<const Inspection>(made_inspection());
    return {made->recording, [](const Settings& settings, std::stop_token, const Progress&) {
              auto inspection = std::make_shared<Inspection>(*made);
              inspection->settings = settings;
              return inspection;
            }};
  }

  TestFolder folder_;
  OffscreenContext context_{640, 400};
  Gui gui_;
  WorkbenchHost host_{gui_, [](const auto&...) { return open(); }, "example"};
};

TEST_F(MovieTest, HasTheFramesOfTheWindowAtTheRecordingsSize) {
  WorkbenchState& state = host_.state;
  ASSERT_TRUE(state.document.recording);
  run_line(state, "set start 5");
  host_.settle();
  const fs::path file = folder_.path() / "m.mp4";
  run_line(state, "export-video " + file.string());
  host_.settle();
  const std::vector<cv::Mat> frames = frames_of(file);
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(state.document.settings.frames));
  const Camera& camera = state.document.recording->camera;
  EXPECT_EQ(frames[0].size(), even_size({camera.width, camera.height}));
  run_line(state, "frame 5");
  EXPECT_LT(mean_difference(frames[0], host_.image("picture", frames[0].size())), 8);
  EXPECT_GT(mean_difference(frames[0], frames.back()), 8);
  EXPECT_THAT(state.messages.text, HasSubstr("saved"));
}

TEST_F(MovieTest, WritesOneFramePerCallAndDeletesACanceledFile) {
  WorkbenchState& state = host_.state;
  const fs::path file = folder_.path() / "m.mp4";
  run_line(state, "export-video " + file.string() + " 12.5");
  const int frame = state.view.frame;
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(host_.busy());
    host_.synchronize();
  }
  EXPECT_EQ(state.view.frame, frame);
  EXPECT_FALSE(fs::exists(file));
  EXPECT_FALSE(fs::is_empty(folder_.path()));
  run_line(state, "escape");
  host_.synchronize();
  EXPECT_FALSE(host_.busy());
  EXPECT_TRUE(fs::is_empty(folder_.path()));
  EXPECT_THAT(state.messages.text, HasSubstr("canceled"));
}

TEST_F(MovieTest, RejectsWrongNamesRatesAndFolders) {
  EXPECT_THAT(test::refusal(host_.state, "export-video a.avi"), HasSubstr(".mp4"));
  EXPECT_THAT(test::refusal(host_.state, "export-video a.mp4 0"), HasSubstr("1 to 240"));
  EXPECT_THAT(test::refusal(host_.state, "export-video /nowhere/a.mp4"), HasSubstr("/nowhere"));
  EXPECT_FALSE(host_.busy());
}

TEST_F(MovieTest, ShowsTheColumnsInCompareMode) {
  WorkbenchState& state = host_.state;
  const fs::path file = folder_.path() / "c.mp4";
  const auto draw = [this](const WorkbenchState& shown, const std::string& view, cv::Size size) {
    EXPECT_EQ(view, "compare");
    host_.state.view.frame = shown.view.frame;
    return host_.image(view, size);
  };
  WorkbenchState two = state;
  two.view.panes.compare = true;
  two.document.compared = parse_configurations("gpo,ba");
  two.document.settings.frames = 4;
  Movie movie({file, 10}, two);
  while (!movie.finished()) movie.step(draw);
  const std::vector<cv::Mat> frames = frames_of(file);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames[0].size(), even_size(default_compare_size(2, *state.document.recording)));
}

}  // namespace
}  // namespace gpo
