// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Range and marked values of an axis.
struct AxisTicks {
  double low = 0, high = 1;
  std::vector<double> values;
  std::vector<std::string> labels;  ///< one per value
};

/// Returns at least three, about `most` ticks at multiples of 1, 2 or 5 times a power of ten. A
/// range of one value is extended to both sides.
AxisTicks linear_ticks(double low, double high, int most);

/// Extends the range, > 0, to 1, 2 or 5 times a power of ten. Ticks are at such numbers, only at
/// (some) powers of ten if that is enough, at linear steps if there would be fewer than three.
AxisTicks logarithmic_ticks(double low, double high, int most);

/// Maps values of a chart to its image or to the screen.
struct ChartMapping {
  bool logarithmic = false;  ///< the y axis
  double x_low = 0, x_high = 1, y_low = 0, y_high = 1;
  double left = 0, bottom = 0;  ///< intersection of the axes [px]
  double width = 1;             ///< length of the x axis [px]
  double height = 1;            ///< length of the y axis [px]; negative if y points down

  double x_px(double value) const { return left + width * (value - x_low) / (x_high - x_low); }
  double y_px(double value) const {
    const double part = logarithmic ? std::log(value / y_low) / std::log(y_high / y_low)
                                    : (value - y_low) / (y_high - y_low);
    return bottom + height * part;
  }
  Eigen::Vector2d px(double x, double y) const { return {x_px(x), y_px(y)}; }
  double x_value(double px) const { return x_low + (x_high - x_low) * (px - left) / width; }
  double y_value(double px) const {
    const double part = (px - bottom) / height;
    return logarithmic ? y_low * std::pow(y_high / y_low, part) : y_low + (y_high - y_low) * part;
  }
  bool inside(const Eigen::Vector2d& point_px) const {
    const double u = (point_px.x() - left) / width, v = (point_px.y() - bottom) / height;
    return u >= 0 && u <= 1 && v >= 0 && v <= 1;
  }
};

}  // namespace gpo
