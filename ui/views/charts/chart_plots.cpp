// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/chart_plots.h"

#include "ui/look/palette.h"
#include "ui/views/charts/axis_ticks.h"
#include "ui/views/charts/chart_ticks.h"
#include "ui/views/charts/vtk_text.h"
#include "ui/views/overlay/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <tuple>

#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkChartXY.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlotArea.h>
#include <vtkPlotLine.h>
#include <vtkPlotPoints.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

namespace gpo {
namespace {

using Eigen::Vector2d;

constexpr double kDashPeriod_px = 32;  ///< of curves over others, at scale 1

void set_color(vtkPen& pen, std::uint32_t rgb) { pen.SetColorF(red(rgb), green(rgb), blue(rgb)); }

bool drawable(double value, bool logarithmic) {
  return std::isfinite(value) && (!logarithmic || value > 0);
}

/// A chart on its way to VTK, in pixels: VTK's own scaling of a chart would stretch the strokes of
/// an SVG, its logarithmic ticks crowd, and its dashes depend on what draws them.
struct Plot {
  vtkChartXY& vtk;
  double scale;
  const ChartLook& look;
  ChartMapping to;

  bool good(double x_value, double y_value) const {
    return std::isfinite(x_value) && drawable(y_value, to.logarithmic);
  }
};

using Line = std::vector<Vector2d>;

/// The curve without its gaps; VTK's own handling of gaps draws bands through them.
std::vector<Line> runs(const Plot& plot, std::span<const double> x, std::span<const double> y) {
  std::vector<Line> result;
  bool gap = true;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const bool good = plot.good(x[i], y[i]);
    if (good && gap) result.emplace_back();
    if (good) result.back().push_back(plot.to.px(x[i], y[i]));
    gap = !good;
  }
  return result;
}

/// Columns named by their index: x, and one y a line. The lines have the same x.
vtkSmartPointer<vtkTable> table(std::span<const Line> lines) {
  auto result = vtkSmartPointer<vtkTable>::New();
  const auto add = [&](const Line& line, int axis) {
    vtkNew<vtkDoubleArray> column;
    column->SetName(std::to_string(result->GetNumberOfColumns()).c_str());
    for (const Vector2d& point : line) column->InsertNextValue(point[axis]);
    result->AddColumn(column);
  };
  add(lines.front(), 0);
  for (const Line& line : lines) add(line, 1);
  return result;
}

vtkPlot& add_plot(const Plot& plot, int type, const Line& line, std::uint32_t rgb) {
  vtkPlot& added = *plot.vtk.AddPlot(type);
  added.SetInputData(table({&line, 1}), 0, 1);
  set_color(*added.GetPen(), rgb);
  return added;
}

void add_markers(const Plot& plot, const Line& points, std::uint32_t rgb, double size_px) {
  if (points.empty()) return;
  auto& added = dynamic_cast<vtkPlotPoints&>(add_plot(plot, vtkChart::POINTS, points, rgb));
  added.SetMarkerStyle(vtkPlotPoints::CIRCLE);
  added.SetMarkerSize(static_cast<float>(size_px));
}

void add_line(const Plot& plot, const Line& line, std::uint32_t rgb, double width_px) {
  if (line.size() < 2) return;
  auto& added = dynamic_cast<vtkPlotLine&>(add_plot(plot, vtkChart::LINE, line, rgb));
  added.GetPen()->SetWidth(static_cast<float>(width_px));
}

void add_dots(const Plot& plot, const Line& line, std::uint32_t rgb) {
  add_markers(plot, points_along(line, kDotSpacing_px * plot.scale), rgb, kDotSize_px * plot.scale);
}

void add_band(const Plot& plot, const Curve& curve, std::uint32_t rgb) {
  if (curve.lower.empty()) return;
  // Where one quartile cannot be drawn, neither is the other.
  std::vector<double> lower = curve.lower, upper = curve.upper;
  for (std::size_t i = 0; i < lower.size(); ++i)
    if (!plot.good(curve.x[i], lower[i]) || !plot.good(curve.x[i], upper[i]))
      lower[i] = upper[i] = std::nan("");
  const std::vector<Line> below = runs(plot, curve.x, lower), above = runs(plot, curve.x, upper);
  for (std::size_t i = 0; i < below.size(); ++i) {
    if (below[i].size() == 1) {
      add_line(plot, {below[i][0], above[i][0]}, rgb, plot.scale);
      continue;
    }
    // VTK 9.1 leaves out a band of two points; the last one twice makes three.
    std::array<Line, 2> sides = {below[i], above[i]};
    for (Line& side : sides) side.push_back(side.back());
    auto& band = dynamic_cast<vtkPlotArea&>(*plot.vtk.AddPlot(vtkChart::AREA));
    band.SetInputData(table(sides));
    for (int column = 0; column < 3; ++column) band.SetInputArray(column, std::to_string(column));
    band.GetPen()->SetLineType(vtkPen::NO_PEN);
    band.GetBrush()->SetColorF(red(rgb), green(rgb), blue(rgb), kBandOpacity);
  }
}

/// Whether the one would hide the other: they have places in common, and agree at all of these.
bool coincide(const Line& a, const Line& b, double tolerance_px) {
  int common = 0;
  for (const Vector2d& point : a) {
    bool there = false, near = false;  // where a curve steps there are two at one place
    for (const Vector2d& other : b) {
      if (other.x() != point.x()) continue;
      there = true;
      near = near || std::abs(other.y() - point.y()) <= tolerance_px;
    }
    if (there && !near) return false;
    common += there ? 1 : 0;
  }
  return common > 1;
}

/// Over those drawn before it: in the gaps of its dashes are the ones that it would hide. They are
/// counted from the lowest one's beginning, so that those of several are in step.
void add_line_over(const Plot& plot,
                   const Line& line,
                   std::uint32_t rgb,
                   const std::vector<Line>& drawn) {
  const double width = kCurveWidth_px * plot.scale;
  const auto hides = [&](const Line& other) { return coincide(line, other, width); };
  const auto lowest = std::ranges::find_if(drawn, hides);
  if (lowest == drawn.end()) return add_line(plot, line, rgb, width);
  const double left = line.front().x(), period = kDashPeriod_px * plot.scale;
  const auto hidden = static_cast<int>(std::ranges::count_if(drawn, hides));
  const double dash = std::ldexp(period, -hidden);  // half as long as that of the one below
  const std::array<double, 2> pattern = {dash, period - dash};
  Line path;
  std::ranges::copy_if(
      *lowest, std::back_inserter(path), [&](const Vector2d& p) { return p.x() < left; });
  path.insert(path.end(), line.begin(), line.end());
  for (const auto& [from, to] : dashes_along(path, pattern))
    if (from.x() >= left) add_line(plot, {from, to}, rgb, width);
}

/// `drawn`: the lines so far, to which this curve's are added.
void add_curve(const Plot& plot,
               const Curve& curve,
               const CurveStyle& style,
               std::vector<Line>& drawn) {
  Line points;
  for (const Line& run : runs(plot, curve.x, curve.y)) {
    points.insert(points.end(), run.begin(), run.end());
    if (style.dotted) {
      add_dots(plot, run, style.rgb);
    } else {
      add_line_over(plot, run, style.rgb, drawn);
      drawn.push_back(run);
    }
  }
  if (style.marker) add_markers(plot, points, style.rgb, style.marker_px * plot.scale);
}

/// `range_px` and `places_px` along the axis.
void set_axis(vtkAxis& axis,
              std::pair<double, double> range_px,
              const std::vector<double>& places_px,
              const std::vector<std::string>& texts,
              double scale,
              const ChartLook& look) {
  axis.SetTitle("");
  set_font(*axis.GetLabelProperties(), Weight::regular, look.tick_text_px * scale, look.text);
  set_color(*axis.GetPen(), look.axis);
  set_color(*axis.GetGridPen(), look.grid);
  for (vtkPen* pen : {axis.GetPen(), axis.GetGridPen()}) pen->SetWidth(static_cast<float>(scale));
  axis.SetTickLength(static_cast<float>(5 * scale));
  axis.SetLabelOffset(static_cast<float>(8 * scale));
  axis.SetBehavior(vtkAxis::FIXED);
  axis.SetRange(range_px.first, range_px.second);
  vtkNew<vtkDoubleArray> places;
  vtkNew<vtkStringArray> labels;
  for (const double place : places_px) places->InsertNextValue(place);
  for (const std::string& text : texts) labels->InsertNextValue(text);
  axis.SetCustomTickPositions(places, labels);
}

void set_axes(const Plot& plot, const AxisTicks& x_ticks, const AxisTicks& y_ticks) {
  const ChartMapping& to = plot.to;
  std::vector<double> x, y;
  for (const double value : x_ticks.values) x.push_back(to.x_px(value));
  for (const double value : y_ticks.values) y.push_back(to.y_px(value));
  set_axis(*plot.vtk.GetAxis(vtkAxis::BOTTOM),
           {to.left, to.left + to.width},
           x,
           x_ticks.labels,
           plot.scale,
           plot.look);
  set_axis(*plot.vtk.GetAxis(vtkAxis::LEFT),
           {to.bottom, to.bottom + to.height},
           y,
           y_ticks.labels,
           plot.scale,
           plot.look);
}

const CurveStyle& style_of(const Curve& curve, const std::vector<CurveStyle>& styles) {
  return *std::ranges::find(styles, curve.name, &CurveStyle::name);
}

}  // namespace

ChartMapping fill_chart(vtkChartXY& vtk,
                        const Chart& chart,
                        const std::vector<CurveStyle>& styles,
                        const vtkRectf& axes,
                        double scale,
                        const ChartLook& look) {
  vtk.SetLayoutStrategy(vtkChart::AXES_TO_RECT);
  vtk.SetSize(axes);
  vtk.SetAutoAxes(false);
  vtk.SetRenderEmpty(true);
  vtk.SetShowLegend(false);
  for (const int side : {vtkAxis::TOP, vtkAxis::RIGHT}) vtk.GetAxis(side)->SetVisible(false);
  Plot plot{vtk, scale, look, {}};
  ChartMapping& to = plot.to;
  to.left = axes.GetX();
  to.bottom = axes.GetY();
  to.width = axes.GetWidth();
  to.height = axes.GetHeight();
  if (!has_values(chart)) {
    set_axes(plot, {}, {});
    return to;
  }
  const AxisTicks x = x_ticks(chart, to.width, 50 * scale);
  const AxisTicks y = y_ticks(chart, to.height, look.tick_spacing_px * scale);
  to.logarithmic = chart.logarithmic;
  std::tie(to.x_low, to.x_high, to.y_low, to.y_high) = std::tuple(x.low, x.high, y.low, y.high);
  set_axes(plot, x, y);
  for (const Curve& curve : chart.curves) add_band(plot, curve, style_of(curve, styles).rgb);
  std::vector<Line> drawn;
  for (const bool bounds : {true, false})
    for (const Curve& curve : chart.curves)
      if (curve.dotted == bounds) add_curve(plot, curve, style_of(curve, styles), drawn);
  return to;
}

}  // namespace gpo
