// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/tracking/soft_picture.h"

#include <cstdint>

#include <gtest/gtest.h>

namespace gpo {
namespace {

TEST(SoftPicture, SpreadsAPixelOverItsNeighbors) {
  cv::Mat gray(9, 11, CV_8UC1, cv::Scalar(0));
  gray.at<std::uint8_t>(4, 5) = 100;
  const cv::Mat soft = soften(gray);
  ASSERT_EQ(soft.type(), CV_16UC1);
  const int weights[] = {1, 6, 1};
  for (int v = 0; v < 9; ++v) {
    for (int u = 0; u < 11; ++u) {
      const bool near = std::abs(v - 4) <= 1 && std::abs(u - 5) <= 1;
      EXPECT_EQ(soft.at<std::uint16_t>(v, u), near ? 100 * weights[v - 3] * weights[u - 4] : 0);
    }
  }
}

TEST(SoftPicture, KeepsAnEvenPictureAtItsEdgesToo) {
  const cv::Mat soft = soften(cv::Mat(6, 7, CV_8UC1, cv::Scalar(255)));
  for (const std::uint16_t value : cv::Mat_<std::uint16_t>(soft)) EXPECT_EQ(value, 255 * kSoftGain);
  for (const std::uint16_t value : cv::Mat_<std::uint16_t>(halved(soft)))
    EXPECT_EQ(value, 255 * kSoftGain);
}

TEST(SoftPicture, HalvesToTheMeansOfFour) {
  cv::Mat soft(5, 6, CV_16UC1);
  for (int v = 0; v < 5; ++v)
    for (int u = 0; u < 6; ++u)
      soft.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(10 * v + u);
  const cv::Mat half = halved(soft);
  ASSERT_EQ(half.size(), cv::Size(3, 2));
  EXPECT_EQ(half.at<std::uint16_t>(0, 0), (0 + 1 + 10 + 11) / 4);
  EXPECT_EQ(half.at<std::uint16_t>(1, 2), (24 + 25 + 34 + 35) / 4);
}

}  // namespace
}  // namespace gpo
