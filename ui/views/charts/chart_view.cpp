// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/chart_view.h"

#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/context/vtk_window.h"
#include "ui/context/window_picture.h"
#include "ui/views/charts/chart_plots.h"
#include "ui/views/charts/chart_ticks.h"
#include "ui/views/overlay/overlay.h"
#include "ui/views/picture/picture_texture.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include <fmt/format.h>
#include <imgui.h>
#include <vtkChartXY.h>
#include <vtkContextActor.h>
#include <vtkContextScene.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

namespace gpo {
namespace {

/// In the colors of the current theme.
ChartLook screen_look() {
  return {color_of(Role::panel),
          color_of(Role::text_dim),
          color_of(Role::border),
          color_of(Role::raised),
          12,
          26};
}

// Around the axes, at scale 1 [px].
constexpr double kLeft = 54, kRight = 14, kBottom = 38, kTop = 24;

/// Curves of fewer points show where these are.
constexpr std::size_t kMostMarked = 40;

/// Gaps (NaN) are equal.
bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::ranges::equal(a, b, [](double left, double right) {
    return left == right || (std::isnan(left) && std::isnan(right));
  });
}

bool same(const Curve& a, const Curve& b) {
  return a.name == b.name && a.rgb == b.rgb && a.dotted == b.dotted && same(a.x, b.x) &&
         same(a.y, b.y) && same(a.lower, b.lower) && same(a.upper, b.upper);
}

/// What is in the texture; titles are not.
bool same(const Chart& a, const Chart& b) {
  return a.logarithmic == b.logarithmic &&
         std::ranges::equal(
             a.curves, b.curves, [](const Curve& x, const Curve& y) { return same(x, y); });
}

std::vector<CurveStyle> screen_styles(const Chart& chart) {
  std::vector<CurveStyle> styles;
  for (const Curve& curve : chart.curves) {
    if (std::ranges::count(styles, curve.name, &CurveStyle::name) > 0) continue;
    const bool marked = !curve.dotted && curve.lower.empty() && curve.x.size() <= kMostMarked;
    styles.push_back({curve.name,
                      curve.rgb,
                      curve.dotted,
                      {},
                      marked ? std::optional<int>(0) : std::nullopt,
                      5});
  }
  return styles;
}

struct TextWriter {
  ImDrawList& list;
  const ImFont* font;

  double width(const std::string& text) const {
    return font->CalcTextSizeA(font->FontSize, INFINITY, 0, text.c_str()).x;
  }
  void write(double x, double y, const std::string& text, std::uint32_t rgb) const {
    list.AddText(font,
                 font->FontSize,
                 {static_cast<float>(std::round(x)), static_cast<float>(std::round(y))},
                 imgui_color(rgb),
                 text.c_str());
  }
};

/// A key of the legend at its place, in the chart's upper left corner's coordinates [px].
struct Key {
  const Curve* curve;
  double x, y;
};

struct Legend {
  std::vector<Key> keys;
  int rows = 0;  ///< below the row of the titles; 0: beside them, or no legend
};

constexpr double kSample = 16, kSampleGap = 5, kKeyGap = 14, kRow = 17, kInset = 6;

/// Beside the titles, which are `titles_px` wide, where there is room, else in rows below them.
Legend place_legend(
    const Chart& chart, const TextWriter& text, double width, double titles_px, double s) {
  std::vector<std::pair<const Curve*, double>> named;  // widths
  double total = 0;
  for (const Curve& curve : chart.curves) {
    const auto taken = [&](const auto& other) { return other.first->name == curve.name; };
    if (curve.name.empty() || std::ranges::any_of(named, taken)) continue;
    named.emplace_back(&curve, (kSample + kSampleGap + kKeyGap) * s + text.width(curve.name));
    total += named.back().second;
  }
  Legend legend;
  if (named.size() < 2) return legend;
  const double room = width - (kInset + kRight) * s;
  const bool beside = titles_px + 2 * kKeyGap * s + total <= room;
  double x = beside ? width - kRight * s - total : kInset * s;
  legend.rows = beside ? 0 : 1;
  for (const auto& [curve, key_width] : named) {
    if (!beside && x > kInset * s && x + key_width > width - kRight * s) {
      x = kInset * s;
      ++legend.rows;
    }
    legend.keys.push_back({curve, x, (4 + kRow * legend.rows) * s});
    x += key_width;
  }
  return legend;
}

void draw_key(const TextWriter& text, const Key& key, const Eigen::Vector2d& corner, double s) {
  const Eigen::Vector2d at = corner + Eigen::Vector2d(key.x, key.y);
  const auto y = static_cast<float>(std::round(at.y() + text.font->FontSize / 2));
  const auto x = static_cast<float>(at.x()), end = static_cast<float>(at.x() + kSample * s);
  const ImU32 color = imgui_color(key.curve->rgb);
  const auto width = static_cast<float>(2 * s);
  if (key.curve->dotted)
    for (float dot = x + width; dot < end; dot += 2.5F * width)
      text.list.AddCircleFilled({dot, y}, 0.8F * width, color, 8);
  else
    text.list.AddLine({x, y}, {end, y}, color, width);
  text.write(at.x() + (kSample + kSampleGap) * s, at.y(), key.curve->name, color_of(Role::text));
}

}  // namespace

struct ChartView::Pipeline {
  vtkSmartPointer<VtkWindow> window = make_vtk_window();
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkContextActor> actor;
  Chart chart;
  int width = 0, height = 0;
  double scale = 0, top_px = 0;
  ChartMapping mapping;
  std::size_t revision = 0;
  Theme theme = Theme::dark;

  Pipeline() {
    renderer->SetBackgroundAlpha(1);
    window->AddRenderer(renderer);
    renderer->AddActor(actor);
    actor->GetScene()->SetRenderer(renderer);
  }
  ~Pipeline() { window->Finalize(); }
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  bool changed(const Chart& other, int w, int h, double s, double top) const {
    return revision == 0 || theme != current_theme() || w != width || h != height || s != scale ||
           top != top_px || !same(chart, other);
  }

  void fill() {
    const double s = scale;
    const ChartLook look = screen_look();
    theme = current_theme();
    renderer->SetBackground(red(look.ground), green(look.ground), blue(look.ground));
    const vtkRectf axes(
        static_cast<float>(std::round(kLeft * s)),
        static_cast<float>(std::round(kBottom * s)),
        static_cast<float>(std::max(8.0, std::round(width - (kLeft + kRight) * s))),
        static_cast<float>(std::max(8.0, std::round(height - kBottom * s - top_px))));
    vtkContextScene& scene = *actor->GetScene();
    scene.ClearItems();
    vtkNew<vtkChartXY> plots;
    mapping = fill_chart(*plots, chart, screen_styles(chart), axes, s, look);
    scene.AddItem(plots);
    // VTK's y is up.
    mapping.bottom = height - mapping.bottom;
    mapping.height = -mapping.height;
  }
};

ChartView::ChartView() : pipeline_(std::make_unique<Pipeline>()) {}
ChartView::~ChartView() = default;

const ChartMapping& ChartView::mapping() const { return pipeline_->mapping; }
std::size_t ChartView::revision() const { return pipeline_->revision; }

unsigned ChartView::render(const Chart& chart, int width, int height, double scale, double top_px) {
  if (width < 1 || height < 1) return 0;
  Pipeline& p = *pipeline_;
  if (!p.changed(chart, width, height, scale, top_px)) return texture_of(*p.window);
  p.chart = chart;
  p.width = width;
  p.height = height;
  p.scale = scale;
  p.top_px = top_px;
  p.fill();
  ++p.revision;
  return render_to_texture(*p.window, width, height);
}

ChartMapping draw_chart_view(ImDrawList& list,
                             const ScreenRect& rect,
                             ChartView& view,
                             const Chart& chart,
                             bool with_legend) {
  const double s = overlay_scale();
  const Eigen::Vector2d corner = rect.min.array().round();
  const Eigen::Vector2d size = rect.size.array().round();
  const TextWriter text{list, font(Font::small)};
  const TextWriter bold{list, font(Font::bold)};
  const double title = chart.title.empty() ? 0 : bold.width(chart.title) + 10 * s;
  Legend legend;
  if (with_legend)
    legend = place_legend(chart, text, size.x(), kInset * s + title + text.width(chart.y_label), s);
  const double top_px = (kTop + kRow * legend.rows) * s;
  const unsigned texture = view.render(
      chart, static_cast<int>(size.x()), static_cast<int>(size.y()), s, std::round(top_px));
  if (texture == 0) return {};
  mark_content(list, view.revision());
  list.AddImage(imgui_texture(texture), to_imgui(corner), to_imgui(corner + size), {0, 1}, {1, 0});
  if (title > 0)
    bold.write(corner.x() + kInset * s, corner.y() + 3 * s, chart.title, color_of(Role::text));
  text.write(
      corner.x() + kInset * s + title, corner.y() + 4 * s, chart.y_label, color_of(Role::text_dim));
  for (const Key& key : legend.keys) draw_key(text, key, corner, s);
  ChartMapping to = view.mapping();
  to.left += corner.x();
  to.bottom += corner.y();
  const double middle = to.left + to.width / 2;
  text.write(middle - text.width(chart.x_label) / 2,
             corner.y() + size.y() - 18 * s,
             chart.x_label,
             color_of(Role::text_dim));
  if (!has_values(chart)) {
    const std::string nothing = "no values";
    text.write(middle - text.width(nothing) / 2,
               to.bottom + to.height / 2 - text.font->FontSize / 2,
               nothing,
               color_of(Role::text_dim));
  }
  return to;
}

void draw_chart_cursor(ImDrawList& list, const ChartMapping& to, double x, std::uint32_t rgb) {
  if (!(x >= to.x_low && x <= to.x_high)) return;
  const auto at = static_cast<float>(std::round(to.x_px(x)));
  list.AddLine({at, static_cast<float>(to.bottom + to.height)},
               {at, static_cast<float>(to.bottom)},
               imgui_color(rgb),
               std::round(overlay_scale()));
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
    // Where a curve steps there are two points at one x: the one on the side that is asked for.
    const auto [first, end] = std::equal_range(curve.x.begin(), curve.x.end(), *nearest);
    if (first == end) continue;
    const auto at = x < *nearest ? first : std::prev(end);
    const double y = curve.y[at - curve.x.begin()];
    if (std::isfinite(y)) values += fmt::format("\n{}: {:.4g}", curve.name, y);
  }
  if (values.empty()) return values;
  return fmt::format("{}: {:.6g}\n{}{}", chart.x_label, *nearest, chart.y_label, values);
}

}  // namespace gpo
