// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/curve_style.h"

#include "ui/look/palette.h"

#include <algorithm>
#include <array>
#include <map>
#include <numbers>

namespace gpo {
namespace {

/// Returns dashes and gaps of the `turn`-th curve with the same marker [px].
const std::vector<double>& dashes_of(int turn) {
  static const std::array<std::vector<double>, 6> kPatterns = {
      std::vector<double>{}, {8, 5}, {9, 4, 2, 4}, {3, 3}, {16, 5}, {9, 3, 2, 3, 2, 3}};
  return kPatterns[static_cast<std::size_t>(turn) % kPatterns.size()];
}

/// Replacements for colors that look like another one; distinct and dark.
constexpr std::array<std::uint32_t, 10> kOthers = {0x0072B2,
                                                   0xD55E00,
                                                   0x8844AA,
                                                   0x222222,
                                                   0x56B4E9,  //
                                                   0xAA1144,
                                                   0x8B5A2B,
                                                   0xE377C2,
                                                   0x117733,
                                                   0xB8860B};

/// Returns the relative luminance of a channel: 0 black, 1 white.
double linear(double channel) {
  return channel <= 0.04045 ? channel / 12.92 : std::pow((channel + 0.055) / 1.055, 2.4);
}

/// Darkens light colors, such as yellow, for a white ground, in the same hue.
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

/// Converts sRGB to CIE L*a*b*, white point D65.
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

/// Returns the difference from the most similar solid curve; large if there is none.
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

/// A marker with tips around its center, and dents between them.
struct Shape {
  int tips;
  double first_deg;  ///< direction of the first tip, 90: up
  double radius;     ///< distance of the tips [half sizes of the marker]
  double dent;       ///< radius of the dents [radii of the tips]; 0: none
};

constexpr std::array kShapes{
    Shape{24, 0, 1.0, 0},      // circle
    Shape{4, 45, 1.25, 0},     // square
    Shape{3, 90, 1.35, 0},     // triangle
    Shape{4, 90, 1.3, 0},      // diamond
    Shape{3, -90, 1.35, 0},    // inverted triangle
    Shape{5, 90, 1.45, 0.42},  // star
    Shape{4, 45, 1.4, 0.32},   // cross
    Shape{6, 90, 1.15, 0},     // hexagon
    Shape{4, 90, 1.5, 0.32},   // plus
    Shape{3, 90, 1.5, 0.32},   // three-pointed star
};

}  // namespace

std::vector<Eigen::Vector2d> marker_shape(int index, const Eigen::Vector2d& center, double size) {
  const Shape& shape = kShapes[static_cast<std::size_t>(index) % kShapes.size()];
  const int corners = shape.dent > 0 ? 2 * shape.tips : shape.tips;
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < corners; ++i) {
    const double angle = (shape.first_deg + 360.0 * i / corners) * std::numbers::pi / 180;
    const bool dented = shape.dent > 0 && i % 2 == 1;
    const double radius = size / 2 * shape.radius * (dented ? shape.dent : 1);
    outline.push_back(center + radius * Eigen::Vector2d(std::cos(angle), -std::sin(angle)));
  }
  return outline;
}

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
        style.marker = curve.marker.value_or(next++) % static_cast<int>(kShapes.size());
        style.dashes = dashes_of(turns[*style.marker]++);
      }
      styles.push_back(std::move(style));
    }
  return styles;
}

}  // namespace gpo
