// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/images/frame_faults.h"

#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace gpo::test {
namespace {

using enum FrameFault;
using testing::ElementsAre, testing::Each;

/// A smooth texture that moves by `shift` pixels, with noise that differs from image to image.
cv::Mat scene(double shift, int seed) {
  cv::Mat image(48, 64, CV_8UC1);
  cv::RNG random(static_cast<std::uint64_t>(seed + 1));
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(
          120 + 50 * std::sin(0.4 * (x + shift)) * std::cos(0.3 * y) + random.gaussian(0.3));
  return image;
}

TEST(FrameFaults, FindsNoneInMovingAndInRestingCameras) {
  std::vector<cv::Mat> moving, resting;
  for (int i = 0; i < 12; ++i) moving.push_back(scene(0.5 * i, i));
  // It slows down, rests, and starts again.
  for (const double shift : {0.0, 1.0, 1.6, 1.9, 2.0, 2.0, 2.0, 2.0, 2.1, 2.4, 3.0, 4.0})
    resting.push_back(scene(shift, 0));
  EXPECT_THAT(faults_of(moving), Each(none));
  EXPECT_THAT(faults_of(resting), Each(none));
}

TEST(FrameFaults, FindsRepeatsOfASlowerCameraAndOfOneThatHangs) {
  std::vector<cv::Mat> twice, hanging;
  for (int i = 0; i < 10; ++i) twice.push_back(scene(i / 2, i / 2));
  for (const int i : {0, 1, 2, 3, 3, 3, 6, 7, 8, 9}) hanging.push_back(scene(0.5 * i, i));
  const auto of_twice = faults_of(twice);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(of_twice[i], i % 2 == 0 ? none : repeated) << i;
  EXPECT_THAT(faults_of(hanging),
              ElementsAre(none, none, none, none, repeated, repeated, none, none, none, none));
}

TEST(FrameFaults, FindsBlackFramesAndFlashes) {
  std::vector<cv::Mat> images;
  for (int i = 0; i < 9; ++i) images.push_back(scene(0.5 * i, i));
  images[2] = cv::Mat(48, 64, CV_8UC1, cv::Scalar(6));
  images[6] += 70;
  EXPECT_THAT(faults_of(images),
              ElementsAre(none, none, black, none, none, none, flash, none, none));
}

TEST(FrameFaults, LeavesFramesOutOfARecordingAndNamesThem) {
  Recording recording;
  for (int i = 0; i < 10; ++i) recording.timestamps_ns.push_back(i);
  recording.truth.emplace().poses.resize(10);
  recording.images = std::make_shared<const FrameCache>(10, [](int i) {
    cv::Mat bgr;
    cv::cvtColor(scene(i == 5 ? 4 : i, i == 5 ? 4 : i), bgr, cv::COLOR_GRAY2BGR);
    return bgr;
  });
  leave_out_faulty_frames(recording);
  EXPECT_THAT(recording.timestamps_ns, ElementsAre(0, 1, 2, 3, 4, 6, 7, 8, 9));
  EXPECT_EQ(recording.truth->poses.size(), 9U);
  EXPECT_EQ(cv::norm(recording.images->gray(5), scene(6, 6)), 0);
  EXPECT_THAT(recording.notes,
              ElementsAre("1 of 10 frames are left out: 1 (5) repeat the image before"));
}

TEST(FrameFaults, SearchesOnlyTheFramesInUseOfALongRecording) {
  Recording recording;
  for (int i = 0; i < 1000; ++i) recording.timestamps_ns.push_back(i);
  std::set<int> decoded;
  recording.images = std::make_shared<const FrameCache>(1000, [&](int i) {
    decoded.insert(i);
    cv::Mat bgr;
    cv::cvtColor(scene(i == 505 ? 4 : i % 100, i == 505 ? 4 : i % 100), bgr, cv::COLOR_GRAY2BGR);
    return bgr;
  });
  leave_out_faulty_frames(recording, {500, 20});
  EXPECT_EQ(recording.frame_count(), 999);
  EXPECT_EQ(recording.timestamps_ns[505], 506);
  EXPECT_EQ(*decoded.begin(), 500);
  EXPECT_EQ(decoded.size(), 20U);
}

}  // namespace
}  // namespace gpo::test
