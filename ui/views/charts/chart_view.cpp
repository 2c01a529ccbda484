// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/geometry/statistics.h"
#include "ui/views/charts/charts.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

namespace gpo {
namespace {

// Around the axes, at scale 1 [px].
constexpr double kLeft = 54, kRight = 14, kBottom = 38, kTop = 24, kInset = 6, kTitleGap = 10;

/// Curves with fewer points have markers.
constexpr std::size_t kMostMarked = 40;

ChartStyle window_style(Theme theme, double s) {
  return {.ground = color_of(Role::panel, theme),
          .text = color_of(Role::text, theme),
          .tick_text = color_of(Role::text_dim, theme),
          .dim = color_of(Role::text_dim, theme),
          .axis = color_of(Role::border, theme),
          .grid = color_of(Role::raised, theme),
          .scale = s,
          .text_size = 12 * s,
          .tick_size = 12 * s,
          .x_spacing = 50 * s,
          .y_spacing = 26 * s,
          .dashes_coinciding = true,
          .legend = {16 * s, 5 * s, 14 * s, 17 * s, 12 * s}};
}

/// NaN equals NaN: a gap.
bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::ranges::equal(a, b, [](double left, double right) {
    return left == right || (std::isnan(left) && std::isnan(right));
  });
}

bool same(const Curve& a, const Curve& b) {
  return a.name == b.name && a.rgb == b.rgb && a.dotted == b.dotted && a.counts == b.counts &&
         same(a.x, b.x) && same(a.y, b.y) && same(a.lower, b.lower) && same(a.upper, b.upper);
}

bool same(const Chart& a, const Chart& b) {
  return a.title == b.title && a.x_label == b.x_label && a.y_label == b.y_label &&
         a.logarithmic == b.logarithmic &&
         std::ranges::equal(
             a.curves, b.curves, [](const Curve& x, const Curve& y) { return same(x, y); });
}

bool same(const ChartRequest& a, const ChartRequest& b) {
  return a.size == b.size && a.scale == b.scale && a.legend == b.legend && a.theme == b.theme &&
         same(a.chart, b.chart);
}

std::vector<CurveStyle> window_styles(const Chart& chart) {
  std::vector<CurveStyle> styles;
  for (const Curve& curve : chart.curves) {
    if (std::ranges::count(styles, curve.name, &CurveStyle::name) > 0) continue;
    const bool points = curve.lower.empty() || !curve.counts.empty();
    CurveStyle style{curve.name, curve.rgb, curve.dotted};
    style.marker_px = 5;
    if (points && !curve.dotted && curve.x.size() <= kMostMarked) style.marker = 0;
    styles.push_back(std::move(style));
  }
  return styles;
}

std::vector<LegendKey> keys_of(const std::vector<CurveStyle>& styles) {
  std::vector<LegendKey> keys;
  for (const CurveStyle& style : styles)
    if (!style.name.empty()) keys.push_back({&style, style.name});
  return keys.size() < 2 ? std::vector<LegendKey>() : keys;
}

/// Places the keys beside the titles, which end at `titles`, or below. Returns the top of the axes.
double place_legend(std::vector<LegendKey>& keys,
                    const ChartStyle& look,
                    double titles,
                    double width) {
  const double s = look.scale, left = kInset * s, room = width - left - kRight * s;
  const bool beside = titles + 28 * s + width_of(keys, look.legend) <= width - kRight * s;
  const double height = place_keys(keys, look.legend, room, beside ? 1 : 0);
  const double top = beside ? 3 * s : (kTop - 4) * s;
  for (LegendKey& key : keys) key.at += Vector2d(left, top);
  return std::round(kTop * s + (beside ? 0 : height));
}

std::string csv_label(std::string text) {
  std::ranges::replace(text, ',', ';');
  return text;
}

std::string csv_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.9g}", value) : "";
}

constexpr int kBins = 24;

std::uint32_t method_rgb(const Inspection& inspection) {
  return inspection.settings.options.method.row().rgb;
}

std::vector<double> all_of(const WindowResiduals& residuals) {
  std::vector<double> all;
  for (std::size_t i = 1; i < residuals.size(); ++i)
    all.insert(all.end(), residuals[i].begin(), residuals[i].end());
  std::ranges::sort(all);
  return all;
}

/// Returns a round bin width for 99 % of the residuals, but at most for six medians: a few large
/// ones would put all others into the first bin [px].
double bin_width(const std::vector<double>& sorted) {
  const double most =
      std::min(sorted[(sorted.size() - 1) * 99 / 100], 6 * sorted[(sorted.size() - 1) / 2]);
  const AxisTicks ticks = linear_ticks(0, std::max(most, 1e-6), kBins);
  return ticks.values[1] - ticks.values[0];
}

/// The last bin also counts larger values and NaN.
int bin_of(double value, double width) {
  const double bin = std::floor(value / width);
  return bin < kBins ? static_cast<int>(bin) : kBins - 1;
}

/// Returns a histogram in percent, filled down to zero or, for a logarithmic axis, to half a value.
Curve steps(std::string name,
            std::uint32_t rgb,
            std::span<const double> values,
            double width,
            bool logarithmic) {
  std::vector<double> share(kBins, 0);
  for (const double value : values)
    share[bin_of(value, width)] += 100.0 / static_cast<double>(values.size());
  const double least = logarithmic ? 50.0 / static_cast<double>(values.size()) : 0;
  for (double& one : share) one = std::max(one, least);
  Curve curve{.name = std::move(name), .rgb = rgb};
  for (int k = 0; k < kBins; ++k) {
    curve.x.insert(curve.x.end(), {k * width, (k + 1) * width});
    curve.y.insert(curve.y.end(), {share[k], share[k]});
  }
  curve.lower.assign(curve.y.size(), least);
  curve.upper = curve.y;
  return curve;
}

Curve curve_of(const ShownResult& result, double SolverStep::*value) {
  Curve curve{.name = result.name, .rgb = result.rgb};
  for (const SolverStep& step : result.inspection->initialization->solver.trace) {
    curve.x.push_back(static_cast<double>(curve.x.size()));
    curve.y.push_back(step.*value);
  }
  return curve;
}

}  // namespace

ChartImage draw_window_chart(const ChartRequest& request) {
  const Chart& chart = request.chart;
  const ChartStyle look = window_style(request.theme, request.scale);
  const double s = request.scale, size = look.text_size, bold_size = 13 * s;
  const double width = request.size.width, height = request.size.height;
  const std::vector<CurveStyle> styles = window_styles(chart);
  std::vector<LegendKey> keys;
  if (request.legend) keys = keys_of(styles);
  double y_label = kInset * s;
  if (!chart.title.empty()) y_label += width_of(chart.title, bold_size, true) + kTitleGap * s;
  const double top = place_legend(keys, look, y_label + width_of(chart.y_label, size), width);
  const double across = std::max(8.0, std::round(width - (kLeft + kRight) * s));
  const double up = std::max(8.0, std::round(height - kBottom * s - top));
  const cv::Rect2d axes(std::round(kLeft * s), top, across, up);
  ChartImage image;
  image.bgr = drawn_image(request.size, 1, look.ground, [&](cairo_t& cairo) {
    image.mapping = draw_chart(cairo, chart, styles, axes, look);
    const double y = kTop * s / 2, middle = axes.x + axes.width / 2;
    draw_text(cairo, chart.title, {kInset * s, y}, {bold_size, look.text, Anchor::begin, true});
    draw_text(cairo, chart.y_label, {y_label, y}, {size, look.dim, Anchor::begin});
    draw_text(cairo, chart.x_label, {middle, height - 9 * s}, {size, look.dim});
    for (const LegendKey& key : keys) draw_key(cairo, key, look);
  });
  return image;
}

void ChartView::update(const ChartRequest& request) {
  if (texture_.revision() > 0 && same(request, shown_)) return;
  const ChartImage image = draw_window_chart(request);
  texture_.upload(image.bgr);
  mapping_ = image.mapping;
  shown_ = request;
}

ChartMapping draw_chart_view(const Area& area, ChartView& view, const Chart& chart, bool legend) {
  const Vector2d corner = area.rect.min.array().round();
  const Vector2d size = area.rect.size.array().round();
  const cv::Size pixels(static_cast<int>(size.x()), static_cast<int>(size.y()));
  if (pixels.empty()) return {};
  view.update({chart, pixels, overlay_scale(), legend, current_theme()});
  mark_content(area.list, view.texture().revision());
  area.list.AddImage(view.texture().id(), to_imgui(corner), to_imgui(corner + size));
  ChartMapping to = view.mapping();
  to.left += corner.x();
  to.bottom += corner.y();
  return to;
}

void draw_chart_cursor(ImDrawList& list, const ChartMapping& to, double x, std::uint32_t rgb) {
  if (!(x >= to.x_low && x <= to.x_high)) return;
  const auto at = static_cast<float>(std::round(to.x_px(x)));
  const ImVec2 top(at, static_cast<float>(to.bottom + to.height));
  const ImVec2 bottom(at, static_cast<float>(to.bottom));
  list.AddLine(top, bottom, imgui_color(rgb), std::round(overlay_scale()));
}

std::string chart_values_at(const Chart& chart, double x) {
  std::string values;
  std::optional<double> nearest;
  const auto distance = [x](double other) { return std::abs(other - x); };
  for (const Curve& curve : chart.curves)
    for (const double other : curve.x)
      if (!nearest || distance(other) < distance(*nearest)) nearest = other;
  if (!nearest) return values;
  for (const Curve& curve : chart.curves) {
    // A curve that steps has two points at one x: takes the one on the side of `x`.
    const auto [first, end] = std::equal_range(curve.x.begin(), curve.x.end(), *nearest);
    if (first == end) continue;
    const auto at = x < *nearest ? first : std::prev(end);
    const double y = curve.y[at - curve.x.begin()];
    if (std::isfinite(y)) values += fmt::format("\n{}: {:.4g}", curve.name, y);
  }
  if (values.empty()) return values;
  return fmt::format("{}: {:.6g}\n{}{}", chart.x_label, *nearest, chart.y_label, values);
}

std::string to_csv(const Chart& chart) {
  const bool band =
      std::ranges::any_of(chart.curves, [](const Curve& curve) { return !curve.lower.empty(); });
  std::string text = "curve," + csv_label(chart.x_label) + "," + csv_label(chart.y_label);
  text += band ? ",lower,upper\n" : "\n";
  for (const Curve& curve : chart.curves) {
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      text += fmt::format(
          "{},{},{}", csv_label(curve.name), csv_number(curve.x[i]), csv_number(curve.y[i]));
      if (band && curve.lower.empty()) text += ",,";
      if (!curve.lower.empty())
        text += fmt::format(",{},{}", csv_number(curve.lower[i]), csv_number(curve.upper[i]));
      text += '\n';
    }
  }
  return text;
}

WindowResiduals window_residuals(const Inspection& inspection) {
  WindowResiduals residuals;
  for (int i = 0; inspection.initialization->ok && i < inspection.window->frame_count(); ++i)
    residuals.push_back(residuals_px(inspection, i));
  return residuals;
}

Chart residual_histogram(const WindowResiduals& residuals,
                         const Inspection& inspection,
                         int frame,
                         bool logarithmic) {
  Chart chart{.title = "Residuals",
              .x_label = "residual of the solution [px]",
              .y_label = "share [%]",
              .logarithmic = logarithmic};
  const std::vector<double> all = all_of(residuals);
  if (all.empty()) return chart;
  const double width = bin_width(all);
  const std::string name = "window, " + counted(all.size(), "inlier");
  chart.curves.push_back(steps(name, method_rgb(inspection), all, width, logarithmic));
  const int i = frame - inspection.window->start;
  if (i < 1 || i >= static_cast<int>(residuals.size()) || residuals[i].empty()) return chart;
  const std::string own =
      fmt::format("frame {}, {}", frame, counted(residuals[i].size(), "inlier"));
  chart.curves.push_back(steps(own, color_of(Role::residual), residuals[i], width, logarithmic));
  return chart;
}

Chart rms_chart(const WindowResiduals& residuals, const Inspection& shown, const TrackLife* track) {
  Chart chart{
      .title = "Frame by frame", .x_label = "frame", .y_label = "residual of the solution [px]"};
  Curve rms{.name = "RMS of the inliers", .rgb = method_rgb(shown)};
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    rms.x.push_back(shown.window->start + static_cast<double>(i));
    rms.y.push_back(residuals[i].empty() ? NAN : root_mean_square(residuals[i]));
  }
  if (residuals.empty()) return chart;
  chart.curves.push_back(std::move(rms));
  if (track == nullptr) return chart;
  Curve own{.name = fmt::format("track {}", track->id), .rgb = color_of(Role::selected)};
  for (const TrackFrame& frame : track->frames) {
    own.x.push_back(frame.frame);
    own.y.push_back(frame.residual_px.value_or(NAN));
  }
  chart.curves.push_back(std::move(own));
  return chart;
}

std::array<Chart, 3> solver_charts(std::span<const ShownResult> results) {
  std::array<Chart, 3> charts = {Chart{"Cost", "iteration", "half the sum of squares [px\u00b2]"},
                                 Chart{"Gradient", "iteration", "largest component [px\u00b2]"},
                                 Chart{"Step", "iteration", "norm over all unknowns [-]"}};
  for (Chart& chart : charts) chart.logarithmic = true;
  for (auto result = results.rbegin(); result != results.rend(); ++result) {
    if (result->inspection->initialization->solver.trace.empty()) continue;
    charts[0].curves.push_back(curve_of(*result, &SolverStep::cost));
    charts[1].curves.push_back(curve_of(*result, &SolverStep::gradient));
    charts[2].curves.push_back(curve_of(*result, &SolverStep::step));
  }
  return charts;
}

}  // namespace gpo
