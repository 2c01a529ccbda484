// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/images/video_encoder.h"

#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::TestFolder;
using testing::HasSubstr;

cv::Mat disc(int i) {
  cv::Mat image(48, 64, CV_8UC3, cv::Scalar(30, 60, 90));
  cv::circle(image, {8 + 4 * i, 24}, 6, {20, 200, 240}, cv::FILLED);
  return image;
}

TEST(VideoEncoder, WritesACompleteFileOrNone) {
  const TestFolder folder;
  const fs::path file = folder.path() / "a.mp4";
  {
    VideoEncoder video(file, 25, {64, 48});
    video.add(disc(0));
    EXPECT_FALSE(fs::exists(file));
  }
  EXPECT_TRUE(fs::is_empty(folder.path())) << "not finished";
  VideoEncoder video(file, 25, {64, 48});
  EXPECT_THAT(error_of([&] {
                VideoEncoder(folder.path() / "b.mp4", 25, {64, 48}).finish();
              }),
              HasSubstr("b.mp4: not written: there is no image"));
  video.add(disc(0));
  video.finish();
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(VideoEncoder, OpenCvReadsItsVideos) {
  const TestFolder folder;
  constexpr int kFrames = 10;
  for (const double rate_hz : {25.0, 29.97, 12.5, 1.0, 240.0}) {
    const std::string file = (folder.path() / "a.mp4").string();
    VideoEncoder video(file, rate_hz, {64, 48});
    for (int i = 0; i < kFrames; ++i) video.add(disc(i));
    video.finish();
    cv::VideoCapture capture(file, cv::CAP_FFMPEG);
    EXPECT_NEAR(capture.get(cv::CAP_PROP_FPS), rate_hz, 1e-3 * rate_hz);
    int frames = 0;
    for (cv::Mat read; capture.read(read); ++frames) {
      ASSERT_EQ(read.size(), cv::Size(64, 48));
      const double difference = cv::norm(read, disc(frames), cv::NORM_L1) / (3 * 64 * 48);
      EXPECT_LT(difference, 4) << "frame " << frames << " at " << rate_hz << " Hz";
    }
    EXPECT_EQ(frames, kFrames);
  }
}

TEST(VideoEncoder, ReportsFilesAndImagesThatItCannotWrite) {
  EXPECT_THAT(error_of([] {
                VideoEncoder("/nowhere/at/all.mp4", 25, {64, 48});
              }),
              HasSubstr("/nowhere/at/all.mp4: cannot be written"));
  EXPECT_THAT(error_of([] {
                const TestFolder folder;
                VideoEncoder(folder.path() / "a.mp4", 25, {64, 48}).add(cv::Mat(2, 2, CV_8UC3));
              }),
              HasSubstr("size changed"));
}

TEST(VideoEncoder, RoundsSizesUpToEvenOnes) {
  EXPECT_EQ(even_size({639, 480}), cv::Size(640, 480));
}

}  // namespace
}  // namespace gpo
