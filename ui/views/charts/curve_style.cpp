// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/curve_style.h"

#include "ui/look/palette.h"
#include "ui/views/overlay/dash_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <vtkContext2D.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlotPoints.h>

namespace gpo {
namespace {

using Eigen::Vector2d;

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

}  // namespace

std::vector<double> dash_lengths(Dash dash, double scale) {
  if (dash == Dash::dashed) return {8 * scale, 5 * scale};
  return {9 * scale, 4 * scale, 2 * scale, 4 * scale};
}

std::vector<CurveStyle> curve_styles(const Figure& figure) {
  constexpr std::array kMarkers = {
      vtkPlotPoints::CIRCLE, vtkPlotPoints::SQUARE, vtkPlotPoints::DIAMOND};
  constexpr std::array kDashes = {Dash::solid, Dash::dashed, Dash::dash_dot};
  std::vector<CurveStyle> styles;
  std::size_t results = 0;
  for (const Chart& chart : figure.charts)
    for (const Curve& curve : chart.curves) {
      if (std::ranges::count(styles, curve.name, &CurveStyle::name) > 0) continue;
      CurveStyle style{curve.name, on_white(curve.rgb), Dash::dotted, vtkPlotPoints::NONE, false};
      if (!curve.dotted) {
        style.marker = kMarkers[results % kMarkers.size()];
        style.hollow = results / kMarkers.size() % 2 == 1;
        style.dash = kDashes[results / (2 * kMarkers.size()) % kDashes.size()];
        ++results;
      }
      styles.push_back(style);
    }
  return styles;
}

void paint_sample(vtkContext2D& painter,
                  const CurveStyle& style,
                  const vtkRectf& rect,
                  double scale) {
  const double y = rect.GetY() + rect.GetHeight() / 2;
  const std::array line = {Vector2d(rect.GetX(), y), Vector2d(rect.GetX() + rect.GetWidth(), y)};
  vtkNew<vtkPen> pen;
  pen->SetColorF(red(style.rgb), green(style.rgb), blue(style.rgb));
  const auto mark = [&](const Vector2d& at, int marker, double size_px) {
    pen->SetWidth(static_cast<float>(size_px));
    painter.ApplyPen(pen);
    Eigen::Vector2f point = at.cast<float>();
    painter.DrawMarkers(marker, false, point.data(), 1);
  };
  if (style.dash == Dash::dotted) {
    for (const Vector2d& dot : points_along(line, kDotSpacing_px * scale))
      mark(dot, vtkPlotPoints::CIRCLE, kDotSize_px * scale);
    return;
  }
  pen->SetWidth(static_cast<float>(kCurveWidth_px * scale));
  painter.ApplyPen(pen);
  const std::vector<double> pattern = style.dash == Dash::solid
                                          ? std::vector<double>{rect.GetWidth()}
                                          : dash_lengths(style.dash, scale);
  for (const auto& [from, to] : dashes_along(line, pattern)) {
    const Eigen::Vector2f a = from.cast<float>(), b = to.cast<float>();
    painter.DrawLine(a.x(), a.y(), b.x(), b.y());
  }
  if (style.marker == vtkPlotPoints::NONE) return;
  const Vector2d middle = (line[0] + line[1]) / 2;
  mark(middle, style.marker, kMarkerSize_px * scale);
  pen->SetColor(255, 255, 255);
  if (style.hollow) mark(middle, style.marker, kHollow_px * scale);
}

}  // namespace gpo
