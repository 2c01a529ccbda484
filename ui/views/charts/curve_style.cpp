// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/curve_style.h"

#include "ui/look/palette.h"
#include "ui/views/charts/marker_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/Core>

namespace gpo {
namespace {

/// Of the curves with one marker, in turn [px].
const std::vector<double>& dashes_of(int turn) {
  static const std::array<std::vector<double>, 6> kPatterns = {
      std::vector<double>{}, {8, 5}, {9, 4, 2, 4}, {3, 3}, {16, 5}, {9, 3, 2, 3, 2, 3}};
  return kPatterns[static_cast<std::size_t>(turn) % kPatterns.size()];
}

/// For curves that look like another; none is light or like another.
constexpr std::array<std::uint32_t, 10> kOthers = {0x0072B2,
                                                   0xD55E00,
                                                   0x8844AA,
                                                   0x222222,
                                                   0x56B4E9,
                                                   0xAA1144,
                                                   0x8B5A2B,
                                                   0xE377C2,
                                                   0x117733,
                                                   0xB8860B};

/// Relative luminance of a channel: 0 black, 1 white.
double linear(double channel) {
  return channel <= 0.04045 ? channel / 12.92 : std::pow((channel + 0.055) / 1.055, 2.4);
}

/// Yellow would not show on white: as dark as it takes, in the same hue.
std::uint32_t on_white(std::uint32_t rgb) {
  constexpr double kLightest = 0.5;
  const double luminance =
      0.2126 * linear(red(rgb)) + 0.7152 * linear(green(rgb)) + 0.0722 * linear(blue(rgb));
  const double factor = luminance > kLightest ? std::pow(kLightest / luminance, 1 / 2.2) : 1;
  const auto channel = [&](double value) {
    return static_cast<std::uint32_t>(std::lround(255 * factor * value));
  };
  return channel(red(rgb)) << 16 | channel(green(rgb)) << 8 | channel(blue(rgb));
}

/// CIE L*a*b* of sRGB, white point D65.
Eigen::Vector3d lab(std::uint32_t rgb) {
  Eigen::Matrix3d M;
  M << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  const Eigen::Vector3d white(0.9505, 1, 1.089);
  const Eigen::Vector3d xyz =
      M * Eigen::Vector3d(linear(red(rgb)), linear(green(rgb)), linear(blue(rgb)));
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
  const Eigen::Vector3d g = xyz.cwiseQuotient(white).unaryExpr(f);
  return {116 * g.y() - 16, 500 * (g.x() - g.y()), 200 * (g.y() - g.z())};
}

/// From the nearest of the others that are not dotted; much where there are none.
double distance(std::uint32_t rgb, const std::vector<CurveStyle>& others) {
  double least = 1000;
  for (const CurveStyle& other : others)
    if (!other.dotted) least = std::min(least, color_difference(rgb, other.rgb));
  return least;
}

std::uint32_t unlike(const std::vector<CurveStyle>& others, std::uint32_t own) {
  constexpr double kClear = 25;
  if (distance(own, others) >= kClear) return own;
  return *std::ranges::max_element(
      kOthers, {}, [&](std::uint32_t rgb) { return distance(rgb, others); });
}

}  // namespace

double color_difference(std::uint32_t a, std::uint32_t b) { return (lab(a) - lab(b)).norm(); }

std::vector<CurveStyle> curve_styles(const Figure& figure) {
  std::vector<CurveStyle> styles;
  std::map<int, int> turns;  // by marker
  int next = 0;
  for (const Chart& chart : figure.charts)
    for (const Curve& curve : chart.curves) {
      if (std::ranges::count(styles, curve.name, &CurveStyle::name) > 0) continue;
      CurveStyle style{curve.name, on_white(curve.rgb), curve.dotted};
      if (!curve.dotted) {
        style.rgb = unlike(styles, style.rgb);
        style.marker = curve.marker.value_or(next++) % marker_shape_count();
        style.dashes = dashes_of(turns[*style.marker]++);
      }
      styles.push_back(std::move(style));
    }
  return styles;
}

}  // namespace gpo
