// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/image_compare.h"

#include "tests/ui/made_inspection.h"
#include "ui/views/snapshot.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

/// An image drawn by the program, once.
const cv::Mat& drawn() {
  static const cv::Mat image = snapshot_image(made_inspection(), 20);
  return image;
}

TEST(ImageCompare, AcceptsTheSameImage) {
  const ImageComparison result = compare_images(drawn(), drawn());
  EXPECT_TRUE(result.equal);
  EXPECT_EQ(result.unequal, 0);
  EXPECT_TRUE(result.reason.empty());
}

TEST(ImageCompare, AcceptsTwoLevelsOfRoundingEverywhere) {
  cv::Mat noise(drawn().size(), CV_8SC3), noisy;
  cv::RNG(3).fill(noise, cv::RNG::UNIFORM, -2, 3);
  cv::add(drawn(), noise, noisy, cv::noArray(), CV_8U);
  const ImageComparison result = compare_images(noisy, drawn());
  EXPECT_TRUE(result.equal) << result.reason;
  EXPECT_GT(result.beyond[0], 0);
  EXPECT_EQ(result.beyond[1], 0);
}

TEST(ImageCompare, RejectsACubeMovedByTwoPixels) {
  Inspection moved = made_inspection();
  const double depth = to_camera(moved.initialization->cameras[15], moved.cube->origin).z();
  const double two_px = 2 * depth / moved.recording->camera.fx;
  moved.cube->origin += two_px * moved.cube->axes.col(0);
  const ImageComparison result = compare_images(snapshot_image(moved, 20), drawn());
  EXPECT_FALSE(result.equal);
  EXPECT_NE(result.reason.find("16x16"), std::string::npos) << result.reason;
  EXPECT_EQ(result.difference.size(), drawn().size());
}

TEST(ImageCompare, RejectsSwappedColorsAndAShiftByOnePixel) {
  cv::Mat swapped, shifted = drawn().clone();
  cv::cvtColor(drawn(), swapped, cv::COLOR_BGR2RGB);
  EXPECT_FALSE(compare_images(swapped, drawn()).equal);
  drawn().colRange(0, drawn().cols - 1).copyTo(shifted.colRange(1, drawn().cols));
  EXPECT_FALSE(compare_images(shifted, drawn()).equal);
  cv::Mat green = drawn().clone(), red = drawn().clone();
  const cv::Rect mark(320, 300, 12, 12);
  green(mark) = cv::Scalar(10, 200, 30);
  red(mark) = cv::Scalar(10, 30, 200);
  EXPECT_FALSE(compare_images(red, green).equal);
}

TEST(ImageCompare, RejectsAnotherSizeAndNamesBoth) {
  const ImageComparison result = compare_images(drawn().colRange(0, 100), drawn());
  EXPECT_FALSE(result.equal);
  EXPECT_EQ(result.reason, "size 100x480, expected 640x480");
}

TEST(ImageCompare, ToleranceIsTheLargestDifferenceThatCountsAsEqual) {
  const cv::Mat lighter = drawn() + cv::Scalar::all(10);
  EXPECT_FALSE(compare_images(lighter, drawn(), 9).equal);
  EXPECT_TRUE(compare_images(lighter, drawn(), 10).equal);
}

}  // namespace
}  // namespace gpo
