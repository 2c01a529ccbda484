// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/tracking/smoothed_image.h"

#include <cstdint>

#include <gtest/gtest.h>

namespace gpo {
namespace {

TEST(SmoothedImage, SpreadsAPixelOverItsNeighbors) {
  cv::Mat gray(9, 11, CV_8UC1, cv::Scalar(0));
  gray.at<std::uint8_t>(4, 5) = 100;
  const cv::Mat smoothed = smoothed(gray);
  ASSERT_EQ(smoothed.type(), CV_16UC1);
  const int weights[] = {1, 6, 1};
  for (int v = 0; v < 9; ++v) {
    for (int u = 0; u < 11; ++u) {
      const bool near = std::abs(v - 4) <= 1 && std::abs(u - 5) <= 1;
      EXPECT_EQ(smoothed.at<std::uint16_t>(v, u), near ? 100 * weights[v - 3] * weights[u - 4] : 0);
    }
  }
}

TEST(SmoothedImage, KeepsAnEvenImageAtItsEdgesToo) {
  const cv::Mat smoothed = smoothed(cv::Mat(6, 7, CV_8UC1, cv::Scalar(255)));
  for (const std::uint16_t value : cv::Mat_<std::uint16_t>(smoothed)) EXPECT_EQ(value, 255 * kSmoothedGain);
  for (const std::uint16_t value : cv::Mat_<std::uint16_t>(halved(smoothed)))
    EXPECT_EQ(value, 255 * kSmoothedGain);
}

TEST(SmoothedImage, HalvesToTheMeansOfFour) {
  cv::Mat smoothed(5, 6, CV_16UC1);
  for (int v = 0; v < 5; ++v)
    for (int u = 0; u < 6; ++u)
      smoothed.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(10 * v + u);
  const cv::Mat half = halved(smoothed);
  ASSERT_EQ(half.size(), cv::Size(3, 2));
  EXPECT_EQ(half.at<std::uint16_t>(0, 0), (0 + 1 + 10 + 11) / 4);
  EXPECT_EQ(half.at<std::uint16_t>(1, 2), (24 + 25 + 34 + 35) / 4);
}

}  // namespace
}  // namespace gpo
