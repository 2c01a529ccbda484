// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/tracking/patch.h"
#include "engine/frontend/tracking/tracker.h"
#include "engine/geometry/statistics.h"
#include "tests/engine/desk.h"

#include <algorithm>
#include <cstdint>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

TEST(SmoothedImage, SpreadsAPixelOverItsNeighbors) {
  cv::Mat gray(9, 11, CV_8UC1, cv::Scalar(0));
  gray.at<std::uint8_t>(4, 5) = 100;
  const cv::Mat smoothed = smooth_image(gray);
  ASSERT_EQ(smoothed.type(), CV_16UC1);
  const int weights[] = {1, 6, 1};
  for (int v = 0; v < 9; ++v) {
    for (int u = 0; u < 11; ++u) {
      const bool near = std::abs(v - 4) <= 1 && std::abs(u - 5) <= 1;
      EXPECT_EQ(smoothed.at<std::uint16_t>(v, u), near ? 100 * weights[v - 3] * weights[u - 4] : 0);
    }
  }
}

TEST(SmoothedImage, KeepsAUniformImageAtItsBorder) {
  const cv::Mat smoothed = smooth_image(cv::Mat(6, 7, CV_8UC1, cv::Scalar(255)));
  for (const std::uint16_t value : cv::Mat_<std::uint16_t>(smoothed))
    EXPECT_EQ(value, 255 * kSmoothedGain);
  for (const std::uint16_t value : cv::Mat_<std::uint16_t>(halved(smoothed)))
    EXPECT_EQ(value, 255 * kSmoothedGain);
}

TEST(SmoothedImage, HalvesToMeansOfFour) {
  cv::Mat smoothed(5, 6, CV_16UC1);
  for (int v = 0; v < 5; ++v)
    for (int u = 0; u < 6; ++u)
      smoothed.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(10 * v + u);
  const cv::Mat half = halved(smoothed);
  ASSERT_EQ(half.size(), cv::Size(3, 2));
  EXPECT_EQ(half.at<std::uint16_t>(0, 0), (0 + 1 + 10 + 11) / 4);
  EXPECT_EQ(half.at<std::uint16_t>(1, 2), (24 + 25 + 34 + 35) / 4);
}

cv::Mat shifted_image(const cv::Mat& gray, double dx, double dy, double gain) {
  cv::Mat shifted;
  const cv::Mat to = (cv::Mat_<double>(2, 3) << 1, 0, dx, 0, 1, dy);
  cv::warpAffine(gray, shifted, to, gray.size(), cv::INTER_LINEAR, cv::BORDER_REFLECT);
  shifted.convertTo(shifted, -1, gain, 10);
  return shifted;
}

TEST(CoarseFlow, EstimatesLargeMotionsForAnyExposure) {
  const cv::Mat gray = test::desk()->images->gray(0);
  const Eigen::Matrix2Xd corners = detect_corners(gray);
  for (const Eigen::Vector2d& by :
       {Eigen::Vector2d(0.4, -0.3), Eigen::Vector2d(43.5, -28.25), Eigen::Vector2d(-62, 39.5)}) {
    for (const double gain : {1.0, 0.6}) {
      const cv::Mat after = shifted_image(gray, by.x(), by.y(), gain);
      const Eigen::Matrix2Xd flow =
          coarse_flow(smoothed_pyramid(gray), smoothed_pyramid(after), corners);
      std::vector<double> errors;
      for (int j = 0; j < corners.cols(); ++j) {
        const Eigen::Vector2d to = corners.col(j) + by;
        const bool stays = to.minCoeff() > 12 && to.x() < gray.cols - 12 && to.y() < gray.rows - 12;
        if (stays) errors.push_back((flow.col(j) - by).norm());
      }
      EXPECT_LT(median(errors), 0.15) << by.transpose() << ", " << gain;
      EXPECT_GT(std::ranges::count_if(errors, [](double e) { return e < 1.5; }),
                0.97 * static_cast<double>(errors.size()))
          << by.transpose() << ", " << gain;
    }
  }
}

TEST(CoarseFlow, IsZeroWithoutTexture) {
  const SmoothedPyramid empty = smoothed_pyramid(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128)));
  Eigen::Matrix2Xd places(2, 3);
  places << 0, 160, 319, 0, 120, 239;
  EXPECT_EQ(coarse_flow(empty, empty, places), Eigen::Matrix2Xd::Zero(2, 3));
  const SmoothedPyramid tiny = smoothed_pyramid(cv::Mat(20, 20, CV_8UC1, cv::Scalar(1)));
  EXPECT_EQ(coarse_flow(tiny, tiny, places), Eigen::Matrix2Xd::Zero(2, 3));
}

}  // namespace
}  // namespace gpo
