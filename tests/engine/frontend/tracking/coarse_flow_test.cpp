// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/tracking/coarse_flow.h"

#include "engine/frontend/tracking/tracker.h"
#include "engine/geometry/statistics.h"
#include "engine/recording/layouts/open_recording.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

cv::Mat moved(const cv::Mat& gray, double dx, double dy, double gain) {
  cv::Mat shifted;
  const cv::Mat to = (cv::Mat_<double>(2, 3) << 1, 0, dx, 0, 1, dy);
  cv::warpAffine(gray, shifted, to, gray.size(), cv::INTER_LINEAR, cv::BORDER_REFLECT);
  shifted.convertTo(shifted, -1, gain, 10);
  return shifted;
}

TEST(CoarseFlow, FollowsFarAndWhateverTheExposure) {
  const cv::Mat gray = open_recording(GPO_SOURCE_DIR "/sequences/desk")->images->gray(0);
  const Eigen::Matrix2Xd corners = detect_corners(gray);
  for (const Eigen::Vector2d& by :
       {Eigen::Vector2d(0.4, -0.3), Eigen::Vector2d(43.5, -28.25), Eigen::Vector2d(-62, 39.5)}) {
    for (const double gain : {1.0, 0.6}) {
      const cv::Mat after = moved(gray, by.x(), by.y(), gain);
      const Eigen::Matrix2Xd flow = coarse_flow(soft_pyramid(gray), soft_pyramid(after), corners);
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

TEST(CoarseFlow, GuessesWhereThereIsNothingToSee) {
  const SoftPyramid empty = soft_pyramid(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128)));
  Eigen::Matrix2Xd places(2, 3);
  places << 0, 160, 319, 0, 120, 239;
  EXPECT_EQ(coarse_flow(empty, empty, places), Eigen::Matrix2Xd::Zero(2, 3));
  const SoftPyramid tiny = soft_pyramid(cv::Mat(20, 20, CV_8UC1, cv::Scalar(1)));
  EXPECT_EQ(coarse_flow(tiny, tiny, places), Eigen::Matrix2Xd::Zero(2, 3));
}

}  // namespace
}  // namespace gpo
