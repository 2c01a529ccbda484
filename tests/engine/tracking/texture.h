// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <functional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo::test {

/// Returns the brightness of a smooth texture in closed form, so that any warp of it is exact.
inline double brightness(const Eigen::Vector2d& p) {
  const double x = p.x();
  const double y = p.y();
  return 128 + 35 * std::sin(0.31 * x + 0.11 * y) + 30 * std::sin(0.13 * x - 0.37 * y + 1) +
         25 * std::sin(0.45 * x + 0.29 * y + 2) * std::cos(0.05 * x - 0.03 * y);
}

/// Returns an image of the texture at `place` of each pixel, CV_8UC1.
inline cv::Mat image_of(const cv::Size& size,
                        const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& place,
                        double gain = 1,
                        double offset = 0) {
  cv::Mat_<std::uint8_t> gray(size);
  gray.forEach([&](std::uint8_t& value, const int at[2]) {
    const Eigen::Vector2d p = place(Eigen::Vector2d(at[1], at[0]));
    value = cv::saturate_cast<std::uint8_t>(offset + gain * brightness(p));
  });
  return gray;
}

}  // namespace gpo::test
