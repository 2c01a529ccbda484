// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Long videos open by their container's index, or show their first frames before it is read.
#include "engine/files/text_file.h"
#include "engine/recording/images/images.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/engine/recording/images/made_video.h"
#include "tests/engine/test_folder.h"

#include <gtest/gtest.h>

namespace gpo {
namespace {

constexpr int kFrames = 2100;

/// Frame i is gray, lighter with its last digit.
int painted_gray(int frame) { return 100 + 10 * (frame % 10); }
/// The encoder gets the limited range and declares the full one.
double decoded_gray(int frame) { return 16 + painted_gray(frame) * 219.0 / 255; }

class LongVideo : public testing::Test {
 protected:
  fs::path make(const char* name, const test::VideoOptions& options = {}) {
    std::vector<cv::Mat> images;
    for (int i = 0; i < kFrames; ++i)
      images.emplace_back(16, 16, CV_8UC3, cv::Scalar::all(painted_gray(i)));
    test::make_video(folder_.path() / name, images, options);
    return folder_.path() / name;
  }
  VideoFile open(const fs::path& file, int first_frames = 0) {
    packets_read_ = 0;
    Camera camera;
    return open_video(
        file, camera, 1 << 20, [this](double) { ++packets_read_; }, first_frames);
  }
  test::TestFolder folder_;
  int packets_read_ = 0;
};

std::vector<std::int64_t> times_at_25_hz(int count) {
  std::vector<std::int64_t> times;
  for (int i = 0; i < count; ++i) times.push_back(i * std::int64_t{40'000'000});
  return times;
}

TEST_F(LongVideo, IsListedByItsIndexWithoutReadingItsPackets) {
  for (const char* name : {"a.avi", "a.mp4", "a.mov"}) {
    const VideoFile video = open(make(name));
    EXPECT_EQ(packets_read_, 0) << name;
    EXPECT_TRUE(video.complete);
    EXPECT_EQ(video.timestamps_ns, times_at_25_hz(kFrames)) << name;
    for (const int frame : {0, 1234, kFrames - 1})
      EXPECT_NEAR(video.images->bgr(frame).at<cv::Vec3b>(8, 8)[0], decoded_gray(frame), 2) << name;
  }
}

TEST_F(LongVideo, IsReadIfFramesAreStoredInAnotherOrderThanShown) {
  const VideoFile video = open(make("b.mp4", {.b_frames = true}));
  EXPECT_EQ(packets_read_, kFrames);
  EXPECT_EQ(video.timestamps_ns, times_at_25_hz(kFrames));
}

TEST_F(LongVideo, IsReadIfItsIndexContradictsItsPackets) {
  const fs::path file = make("c.avi");
  std::string bytes = read_file(file);
  const std::size_t entry = bytes.rfind("idx1") + 8 + 3 * 16;
  ++bytes[entry + 12];  // the size of frame 3
  write_file(file, bytes);
  EXPECT_EQ(open(file).timestamps_ns.size(), kFrames);
  EXPECT_GT(packets_read_, kFrames / 2);
}

TEST_F(LongVideo, WithoutAnIndexListsItsFirstFramesFirst) {
  const fs::path file = make("d.mkv");
  const VideoFile first = open(file, 500);
  EXPECT_FALSE(first.complete);
  EXPECT_EQ(packets_read_, 500);
  EXPECT_EQ(first.timestamps_ns, times_at_25_hz(500 - 16));
  EXPECT_NEAR(first.images->bgr(0).at<cv::Vec3b>(8, 8)[0], decoded_gray(0), 2);
  const VideoFile whole = open(file);
  EXPECT_TRUE(whole.complete);
  EXPECT_EQ(whole.timestamps_ns, times_at_25_hz(kFrames));
}

TEST_F(LongVideo, FirstFramesOfAShortOneAreAll) { EXPECT_TRUE(open(make("e.mkv"), 5000).complete); }

TEST_F(LongVideo, OpensWholeIfOtherFilesDescribeEachFrame) {
  const fs::path file = make("f.mkv");
  std::string times;
  for (int i = 0; i < kFrames; ++i) times += fmt::format("{}\n", 1'000'000'000 + i * 40'000'000LL);
  folder_.write("frame_timestamps.txt", times);
  OpenOptions options;
  options.first_frames = 500;
  const auto recording = open_recording(folder_.path(), options);
  EXPECT_TRUE(recording->complete);
  EXPECT_EQ(recording->frame_count(), kFrames);
}

}  // namespace
}  // namespace gpo
