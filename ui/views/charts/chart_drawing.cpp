// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/charts.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr std::array kSteps = {1.0, 2.0, 5.0};
constexpr int kFewest = 3;  ///< ticks of a readable scale

/// Returns the `index`-th of ..., 0.5, 1, 2, 5, 10, ...; the 0th is 1.
double round_number(int index) {
  const int decade = static_cast<int>(std::floor(index / 3.0));
  // 5 * 10^-2 is not 0.05 to the last bit; 5 / 10^2 is.
  const double power = std::pow(10.0, std::abs(decade));
  const double step = kSteps[index - 3 * decade];
  return decade < 0 ? step / power : step * power;
}

/// Returns the index of the largest round number that is not above `value`.
int round_number_below(double value) {
  constexpr double kSlack = 1 + 1e-9;
  int index = 3 * static_cast<int>(std::floor(std::log10(value)));
  while (round_number(index) > value * kSlack) --index;
  while (round_number(index + 1) <= value * kSlack) ++index;
  return index;
}

void add_tick(AxisTicks& ticks, double value) {
  ticks.values.push_back(value);
  ticks.labels.push_back(fmt::format("{:.10g}", value + 0.0));  // not "-0"
}

// Sizes at scale 1 [px].
constexpr double kCurveWidth_px = 2, kDotSize_px = 3.2, kDotSpacing_px = 6.5;
constexpr double kBandOpacity = 0.18;
/// More bands are drawn as outlines.
constexpr int kMostFilledBands = 3;
constexpr double kOutlinedOpacity = 0.05, kOutlineOpacity = 0.6, kOutlineWidth = 0.8;
constexpr double kHollowShare = 0.55;  ///< empty part of a hollow marker
constexpr double kTick = 5, kTickGap = 4;
constexpr double kDashPeriod = 32;  ///< for curves over equal ones

bool is_few(const Curve& curve, std::size_t i) {
  return !curve.counts.empty() && curve.counts[i] < kFewWindows;
}

Chart with_quartiles_of_many(Chart chart) {
  for (Curve& curve : chart.curves)
    for (auto* side : {&curve.lower, &curve.upper})
      for (std::size_t i = 0; i < side->size(); ++i)
        if (is_few(curve, i)) (*side)[i] = std::nan("");
  return chart;
}

/// The range of finite values; empty if low > high.
struct Extent {
  double low = INFINITY, high = -INFINITY;

  void extend(std::span<const double> values, bool positive) {
    for (const double value : values) {
      if (!std::isfinite(value) || (positive && value <= 0)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
};

int most_ticks(double length, double spacing) {
  return std::max(3, static_cast<int>(length / spacing));
}

/// Leaves room for markers at both ends.
AxisTicks x_ticks(const Extent& extent, int most) {
  const double room = 0.03 * (extent.high - extent.low);
  return linear_ticks(extent.low - room, extent.high + room, most);
}

/// Linear axes include zero.
AxisTicks y_ticks(const Extent& extent, bool logarithmic, int most) {
  if (logarithmic) return logarithmic_ticks(extent.low, extent.high, most);
  const double low = std::min(0.0, extent.low);
  const double room = 0.05 * (extent.high - low);
  return linear_ticks(low < 0 ? low - room : 0, extent.high + room, most);
}

struct Plot {
  cairo_t& cairo;
  const Chart& chart;
  const std::vector<CurveStyle>& styles;
  const ChartStyle& look;
  ChartMapping to;

  const CurveStyle& style_of(const Curve& curve) const {
    return *std::ranges::find(styles, curve.name, &CurveStyle::name);
  }
  bool good(double x, double y) const {
    return std::isfinite(x) && std::isfinite(y) && (!to.logarithmic || y > 0);
  }
  Polyline px(const Curve& curve, const std::vector<double>& y, std::pair<int, int> range) const {
    Polyline line;
    for (int i = range.first; i < range.second; ++i) line.push_back(to.px(curve.x[i], y[i]));
    return line;
  }
};

/// Returns ranges [first, end) of consecutive indices with `good(i)`.
template <class Good>
std::vector<std::pair<int, int>> runs(std::size_t count, const Good& good) {
  std::vector<std::pair<int, int>> found;
  for (int i = 0; i < static_cast<int>(count); ++i) {
    if (!good(i)) continue;
    if (found.empty() || found.back().second != i) found.emplace_back(i, i);
    found.back().second = i + 1;
  }
  return found;
}

void draw_band(const Plot& plot, const Curve& curve, bool filled) {
  if (curve.lower.empty()) return;
  const std::uint32_t rgb = plot.style_of(curve).rgb;
  const double s = plot.look.scale;
  const auto good = [&](int i) {
    return plot.good(curve.x[i], curve.lower[i]) && plot.good(curve.x[i], curve.upper[i]);
  };
  for (const auto& run : runs(curve.x.size(), good)) {
    Polyline below = plot.px(curve, curve.lower, run), above = plot.px(curve, curve.upper, run);
    if (below.size() == 1) {
      stroke_line(plot.cairo, {below[0], above[0]}, {s, {rgb}});
      continue;
    }
    if (!filled)
      for (const Polyline& side : {below, above})
        stroke_line(plot.cairo, side, {kOutlineWidth * s, {rgb, kOutlineOpacity}});
    below.insert(below.end(), above.rbegin(), above.rend());
    fill_polygon(plot.cairo, below, {rgb, filled ? kBandOpacity : kOutlinedOpacity});
  }
}

Pen pen_of(const CurveStyle& style, double s) {
  if (style.dotted) return {kDotSize_px * s, {style.rgb}, {0, kDotSpacing_px * s}, 0, true};
  Pen pen{kCurveWidth_px * s, {style.rgb}, style.dashes};
  for (double& length : pen.dashes) length *= s;
  return pen;
}

/// Returns true if one line would hide the other: they agree at all of their common x values.
bool coincide(const Polyline& a, const Polyline& b, double tolerance) {
  int common = 0;
  for (const Vector2d& point : a) {
    bool there = false, near = false;  // a curve that steps has two points at one x
    for (const Vector2d& other : b) {
      if (other.x() != point.x()) continue;
      there = true;
      near = near || std::abs(other.y() - point.y()) <= tolerance;
    }
    if (there && !near) return false;
    common += there ? 1 : 0;
  }
  return common > 1;
}

/// Dashes a line that would hide lines drawn before, which show in its gaps. The pattern begins
/// where the lowest of them does, so that several lines are in step.
void dash_over(Pen& pen, const Polyline& line, const std::vector<Polyline>& drawn, double s) {
  const auto hides = [&](const Polyline& other) { return coincide(line, other, pen.width); };
  const auto lowest = std::ranges::find_if(drawn, hides);
  if (lowest == drawn.end()) return;
  const auto hidden = static_cast<int>(std::ranges::count_if(drawn, hides));
  const double period = kDashPeriod * s;
  const double dash = std::ldexp(period, -hidden);  // half as long as the dash below
  pen.dashes = {dash, period - dash};
  Vector2d from = lowest->front();
  for (const Vector2d& point : *lowest) {
    if (point.x() >= line.front().x()) break;
    pen.phase += (point - from).norm();
    from = point;
  }
  if (from.x() < line.front().x()) pen.phase += (line.front() - from).norm();
}

void draw_marker(cairo_t& cairo,
                 const CurveStyle& style,
                 const Vector2d& at,
                 const ChartStyle& look,
                 bool hollow) {
  const int shape = style.marker.value_or(0);
  const double size = style.marker_px * look.scale;
  fill_polygon(cairo, marker_shape(shape, at, size), {style.rgb});
  if (hollow) fill_polygon(cairo, marker_shape(shape, at, kHollowShare * size), {look.ground});
}

/// Appends the curve's lines to `drawn`, the lines so far.
void draw_curve(const Plot& plot, const Curve& curve, std::vector<Polyline>& drawn) {
  const CurveStyle& style = plot.style_of(curve);
  const auto good = [&](int i) { return plot.good(curve.x[i], curve.y[i]); };
  for (const auto& run : runs(curve.x.size(), good)) {
    const Polyline line = plot.px(curve, curve.y, run);
    Pen pen = pen_of(style, plot.look.scale);
    if (plot.look.dashes_coinciding && !style.dotted) {
      dash_over(pen, line, drawn, plot.look.scale);
      drawn.push_back(line);
    }
    if (line.size() > 1) stroke_line(plot.cairo, line, pen);
    if (!style.marker) continue;
    for (int i = run.first; i < run.second; ++i)
      draw_marker(plot.cairo, style, line[i - run.first], plot.look, is_few(curve, i));
  }
}

void draw_axes(const Plot& plot, const AxisTicks& x_ticks, const AxisTicks& y_ticks) {
  const auto& [cairo, chart, styles, look, to] = plot;
  const double left = to.left, right = left + to.width, bottom = to.bottom,
               top = bottom + to.height;
  const double s = look.scale, tick = kTick * s, gap = tick + kTickGap * s, size = look.tick_size;
  const Pen grid{s, {look.grid}}, axis{s, {look.axis}};
  for (std::size_t i = 0; i < x_ticks.values.size(); ++i) {
    const double x = to.x_px(x_ticks.values[i]);
    stroke_straight(cairo, {x, top}, {x, bottom}, grid);
    stroke_straight(cairo, {x, bottom}, {x, bottom + tick}, axis);
    draw_text(cairo, x_ticks.labels[i], {x, bottom + gap + size / 2}, {size, look.tick_text});
  }
  for (std::size_t i = 0; i < y_ticks.values.size(); ++i) {
    const double y = to.y_px(y_ticks.values[i]);
    stroke_straight(cairo, {left, y}, {right, y}, grid);
    stroke_straight(cairo, {left - tick, y}, {left, y}, axis);
    draw_text(cairo, y_ticks.labels[i], {left - gap, y}, {size, look.tick_text, Anchor::end});
  }
  stroke_straight(cairo, {left, top}, {left, bottom}, axis);
  stroke_straight(cairo, {left, bottom}, {right, bottom}, axis);
}

}  // namespace

AxisTicks linear_ticks(double low, double high, int most) {
  if (low == high) {
    const double room = low == 0 ? 1 : std::abs(low) / 2;
    low -= room;
    high += room;
  }
  int index = round_number_below((high - low) / most);
  const auto count = [&] {
    return std::floor(high / round_number(index)) - std::ceil(low / round_number(index)) + 1;
  };
  while (count() > most) ++index;
  while (count() < kFewest) --index;
  const double step = round_number(index);
  AxisTicks ticks{low, high, {}, {}};
  const double slack = 1e-9 * (high - low) / step;
  const auto first = static_cast<std::int64_t>(std::ceil(low / step - slack));
  const auto last = static_cast<std::int64_t>(std::floor(high / step + slack));
  for (std::int64_t k = first; k <= last; ++k)
    add_tick(ticks, std::clamp(static_cast<double>(k) * step, low, high));
  return ticks;
}

AxisTicks logarithmic_ticks(double low, double high, int most) {
  const int first = round_number_below(low);
  int last = round_number_below(high);
  if (round_number(last) < high * (1 - 1e-9) || last == first) ++last;
  AxisTicks ticks{round_number(first), round_number(last), {}, {}};
  const auto count = [&](int every) {
    return static_cast<int>(std::floor(1.0 * last / every) - std::ceil(1.0 * first / every)) + 1;
  };
  int every = 1;
  for (const int candidate : {3, 6, 9, 15, 30})
    if ((last - first) / every + 1 > most && count(candidate) >= kFewest) every = candidate;
  if (count(every) < kFewest) {
    const AxisTicks between = linear_ticks(ticks.low, ticks.high, std::max(most, kFewest));
    ticks.values = between.values;
    ticks.labels = between.labels;
    return ticks;
  }
  for (int index = first; index <= last; ++index)
    if (index % every == 0) add_tick(ticks, round_number(index));
  return ticks;
}

ChartMapping draw_chart(cairo_t& cairo,
                        const Chart& whole,
                        const std::vector<CurveStyle>& styles,
                        const cv::Rect2d& axes,
                        const ChartStyle& look) {
  const Chart chart = with_quartiles_of_many(whole);
  Plot plot{.cairo = cairo, .chart = chart, .styles = styles, .look = look, .to = {}};
  ChartMapping& to = plot.to;
  std::tie(to.left, to.bottom, to.width, to.height) =
      std::tuple(axes.x, axes.br().y, axes.width, -axes.height);
  Extent x_extent, y_extent;
  for (const Curve& curve : chart.curves) {
    x_extent.extend(curve.x, false);
    for (const auto* values : {&curve.y, &curve.lower, &curve.upper})
      y_extent.extend(*values, chart.logarithmic);
  }
  if (x_extent.low > x_extent.high || y_extent.low > y_extent.high) {
    draw_axes(plot, {}, {});
    const Vector2d middle(axes.x + axes.width / 2, axes.y + axes.height / 2);
    draw_text(cairo, "no values", middle, {look.text_size, look.dim});
    return to;
  }
  const AxisTicks x = x_ticks(x_extent, most_ticks(axes.width, look.x_spacing));
  const AxisTicks y = y_ticks(y_extent, chart.logarithmic, most_ticks(axes.height, look.y_spacing));
  to.logarithmic = chart.logarithmic;
  std::tie(to.x_low, to.x_high, to.y_low, to.y_high) = std::tuple(x.low, x.high, y.low, y.high);
  draw_axes(plot, x, y);
  const auto bands =
      std::ranges::count_if(chart.curves, [](const Curve& c) { return !c.lower.empty(); });
  for (const Curve& curve : chart.curves) draw_band(plot, curve, bands <= kMostFilledBands);
  std::vector<Polyline> drawn;
  for (const bool bounds : {true, false})
    for (const Curve& curve : chart.curves)
      if (curve.dotted == bounds) draw_curve(plot, curve, drawn);
  return to;
}

double width_of(const std::vector<LegendKey>& keys, const LegendStyle& look) {
  double width = keys.empty() ? 0 : -look.between;
  for (const LegendKey& key : keys)
    width += look.sample + look.beside + width_of(key.text, look.text_size) + look.between;
  return width;
}

double place_keys(std::vector<LegendKey>& keys,
                  const LegendStyle& look,
                  double room,
                  double align) {
  double y = 0;
  for (auto first = keys.begin(); first != keys.end(); y += look.row) {
    std::vector<LegendKey> row = {*first};
    auto end = std::next(first);
    for (; end != keys.end(); ++end) {
      row.push_back(*end);
      if (width_of(row, look) <= room) continue;
      row.pop_back();
      break;
    }
    double x = align * (room - width_of(row, look));
    for (; first != end; ++first) {
      first->at = {x, y + look.row / 2};
      x += width_of({*first}, look) + look.between;
    }
  }
  return y;
}

void draw_key(cairo_t& cairo, const LegendKey& key, const ChartStyle& look) {
  const Vector2d end = key.at + Vector2d(look.legend.sample, 0);
  const Vector2d middle = (key.at + end) / 2;
  if (key.style != nullptr) {
    stroke_line(cairo, {key.at, end}, pen_of(*key.style, look.scale));
    if (key.style->marker) draw_marker(cairo, *key.style, middle, look, false);
  } else {
    draw_marker(cairo, {.name = "", .rgb = look.dim}, middle, look, true);
  }
  const Vector2d beside = end + Vector2d(look.legend.beside, 0);
  draw_text(cairo, key.text, beside, {look.legend.text_size, look.text, Anchor::begin});
}

}  // namespace gpo
