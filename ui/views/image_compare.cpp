// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/image_compare.h"

#include <algorithm>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr int kBlock_px = 16;
constexpr double kMostUnequal = 0.0005;
constexpr double kMostUnequalInBlock = 0.25;

/// Returns the largest difference of any channel, CV_8UC1.
cv::Mat largest_difference(const cv::Mat& actual, const cv::Mat& expected) {
  cv::Mat difference, largest;
  cv::absdiff(actual, expected, difference);
  cv::reduce(
      difference.reshape(1, static_cast<int>(difference.total())), largest, 1, cv::REDUCE_MAX);
  return largest.reshape(1, actual.rows);
}

double worst_block(const cv::Mat& unequal) {
  double worst = 0;
  for (int y = 0; y < unequal.rows; y += kBlock_px)
    for (int x = 0; x < unequal.cols; x += kBlock_px) {
      const cv::Rect block =
          cv::Rect(x, y, kBlock_px, kBlock_px) & cv::Rect(0, 0, unequal.cols, unequal.rows);
      worst = std::max(worst, cv::countNonZero(unequal(block)) / static_cast<double>(block.area()));
    }
  return worst;
}

/// Returns the expected image, pale, with small differences in blue and unequal pixels in red.
cv::Mat drawn_difference(const cv::Mat& expected,
                         const cv::Mat& difference,
                         const cv::Mat& unequal) {
  cv::Mat image;
  cv::cvtColor(expected, image, cv::COLOR_BGR2GRAY);
  image = image / 3 + 160;
  cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
  image.setTo(cv::Scalar(230, 190, 120), difference > 0);
  const cv::Mat zero = cv::Mat::zeros(difference.size(), CV_8U);
  cv::Mat red;
  cv::merge(std::vector<cv::Mat>{zero, zero, difference + 150}, red);
  red.copyTo(image, unequal);
  return image;
}

}  // namespace

ImageComparison compare_images(const cv::Mat& actual, const cv::Mat& expected, int tolerance) {
  ImageComparison result;
  if (actual.size() != expected.size() || actual.empty()) {
    result.reason = fmt::format(
        "size {}x{}, expected {}x{}", actual.cols, actual.rows, expected.cols, expected.rows);
    return result;
  }
  const cv::Mat difference = largest_difference(actual, expected);
  for (std::size_t i = 0; i < result.beyond.size(); ++i)
    result.beyond[i] = cv::countNonZero(difference > ImageComparison::kSweep[i]);
  const cv::Mat unequal = difference > tolerance;
  result.unequal = cv::countNonZero(unequal);
  result.worst_block = worst_block(unequal);
  result.difference = drawn_difference(expected, difference, unequal);
  const double share = result.unequal / static_cast<double>(unequal.total());
  result.equal = share <= kMostUnequal && result.worst_block <= kMostUnequalInBlock;
  if (!result.equal)
    result.reason = fmt::format(
        "{} pixels ({:.3f} %) differ by more than {} levels, {:.0f} % of the worst 16x16 block; "
        "allowed: {} % and {} %",
        result.unequal,
        100 * share,
        tolerance,
        100 * result.worst_block,
        100 * kMostUnequal,
        100 * kMostUnequalInBlock);
  return result;
}

}  // namespace gpo
