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

/// The largest difference of any channel, CV_8UC1.
cv::Mat largest_difference(const cv::Mat& actual, const cv::Mat& expected) {
  cv::Mat difference;
  cv::absdiff(actual, expected, difference);
  std::array<cv::Mat, 3> channels;
  cv::split(difference, channels.data());
  return cv::max(channels[0], cv::max(channels[1], channels[2]));
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

/// The expected picture, pale, with what differs in red.
cv::Mat drawn_difference(const cv::Mat& expected,
                         const cv::Mat& difference,
                         const cv::Mat& unequal) {
  cv::Mat gray, image;
  cv::cvtColor(expected, gray, cv::COLOR_BGR2GRAY);
  gray = gray / 3 + 160;
  cv::cvtColor(gray, image, cv::COLOR_GRAY2BGR);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      const int d = difference.at<uchar>(y, x);
      if (unequal.at<uchar>(y, x) != 0)
        image.at<cv::Vec3b>(y, x) = {0, 0, static_cast<uchar>(std::min(255, 150 + d))};
      else if (d > 0)
        image.at<cv::Vec3b>(y, x) = {230, 190, 120};
    }
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
        "allowed are {} % and {} %",
        result.unequal,
        100 * share,
        tolerance,
        100 * result.worst_block,
        100 * kMostUnequal,
        100 * kMostUnequalInBlock);
  return result;
}

}  // namespace gpo
