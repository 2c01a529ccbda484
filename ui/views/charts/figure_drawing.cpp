// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "ui/views/charts/charts.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>

namespace gpo {
namespace {

// Size of a chart with titles at which text has its nominal size [px].
constexpr int kChartWidth = 500, kChartHeight = 440;
constexpr double kFreeHeight = 205;  // for the axes on a sheet as high as its content, at scale 1
constexpr double kMargin = 10;       // at scale 1
constexpr double kLineSpacing = 1.35;
constexpr std::uint32_t kWhite = 0xFFFFFF;

bool is_drawn(const Chart& chart, double y) {
  return std::isfinite(y) && (y > 0 || !chart.logarithmic);
}

bool has_few_windows(const Figure& figure) {
  for (const Chart& chart : figure.charts)
    for (const Curve& curve : chart.curves)
      for (std::size_t i = 0; i < curve.counts.size(); ++i)
        if (curve.counts[i] > 0 && curve.counts[i] < kFewWindows && is_drawn(chart, curve.y[i]))
          return true;
  return false;
}

/// Returns whether any chart shows a curve of this name.
bool is_shown(const Figure& figure, const std::string& name) {
  return std::ranges::any_of(figure.charts, [&](const Chart& chart) {
    return std::ranges::any_of(chart.curves, [&](const Curve& curve) {
      return curve.name == name &&
             std::ranges::any_of(curve.y, [&](double y) { return is_drawn(chart, y); });
    });
  });
}

ChartStyle paper_style(const FigureSheet& sheet) {
  const double s = sheet.scale;
  const FigureType& type = sheet.type;
  return {.ground = 0xFFFFFF,
          .text = palette::kInk,
          .tick_text = palette::kInk,
          .dim = palette::kPaperAxis,
          .axis = palette::kPaperAxis,
          .grid = palette::kPaperGrid,
          .scale = s,
          .text_size = type.axis_title,
          .tick_size = type.tick,
          .x_spacing = 3.6 * type.tick,
          .y_spacing = 2.2 * type.tick,
          .legend = {40 * s, 8 * s, 26 * s, 1.7 * type.legend, type.legend}};
}

int chart_count(const Figure& figure) {
  return std::max(1, static_cast<int>(figure.charts.size()));
}

struct PlacedFigure {
  const Figure& figure;
  const FigureSheet& sheet;
  std::vector<CurveStyle> styles = curve_styles(figure);
  FigureLayout layout = lay_out(figure, styles, sheet);

  void draw(cairo_t& cairo) const;
  double width_pt() const { return layout.width * points_per_unit(); }
  double height_pt() const { return layout.height * points_per_unit(); }
  double points_per_unit() const { return sheet.unit_mm / 25.4 * 72; }
};

void write_lines(cairo_t& cairo,
                 const std::vector<std::string>& lines,
                 Vector2d at,
                 const TextFormat& style) {
  for (const std::string& line : lines) {
    draw_text(cairo, line, at, style);
    at.y() += kLineSpacing * style.size;
  }
}

void write_titles(cairo_t& cairo,
                  const Chart& chart,
                  const cv::Rect2d& axes,
                  const FigureSheet& sheet) {
  const FigureType& type = sheet.type;
  const std::uint32_t rgb = palette::kInk;
  const double x = axes.x + axes.width / 2, y = axes.y + axes.height / 2;
  const double below = axes.br().y + 9 * sheet.scale + 1.1 * type.tick + type.axis_title;
  const double beside = axes.x - 3.3 * type.tick - type.axis_title;
  const Vector2d above(x, axes.y - type.chart_title);
  draw_text(cairo, chart.title, above, {.size = type.chart_title, .rgb = rgb, .bold = true});
  draw_text(cairo, chart.x_label, {x, below}, {type.axis_title, rgb});
  const TextFormat upwards{.size = type.axis_title, .rgb = rgb, .upwards = true};
  draw_text(cairo, chart.y_label, {beside, y}, upwards);
}

void PlacedFigure::draw(cairo_t& cairo) const {
  const ChartStyle look = paper_style(sheet);
  const double middle = layout.width / 2;
  const TextFormat title{.size = sheet.type.title, .rgb = look.text, .bold = true};
  write_lines(cairo, layout.title, {middle, layout.title_y}, title);
  for (std::size_t i = 0; i < figure.charts.size(); ++i) {
    draw_chart(cairo, figure.charts[i], styles, layout.axes[i], look);
    write_titles(cairo, figure.charts[i], layout.axes[i], sheet);
  }
  for (const LegendKey& key : layout.keys) draw_key(cairo, key, look);
  write_lines(cairo, layout.note, {middle, layout.note_y}, {sheet.type.note, look.dim});
  if (figure.charts.empty())
    draw_text(cairo, "no charts", {middle, layout.height / 2}, {sheet.type.title, look.text});
}

std::string description(const Figure& figure) {
  std::string text;
  for (const Chart& chart : figure.charts) {
    text += fmt::format("{} ({} over {}):", chart.title, chart.y_label, chart.x_label);
    for (const Curve& curve : chart.curves) text += fmt::format(" {};", curve.name);
    text += ' ';
  }
  return text + figure.note;
}

cairo_status_t append_bytes(void* bytes, const unsigned char* data, unsigned size) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

/// Escapes a text as content of an XML element.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : legible(text, 4 * text.size()))
    result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return result;
}

/// Returns dashes and gaps of the `turn`-th curve with the same marker [px].
const std::vector<double>& dashes_of(int turn) {
  static const std::array<std::vector<double>, 6> kPatterns = {
      std::vector<double>{}, {8, 5}, {9, 4, 2, 4}, {3, 3}, {16, 5}, {9, 3, 2, 3, 2, 3}};
  return kPatterns[static_cast<std::size_t>(turn) % kPatterns.size()];
}

/// Replacements for colors that look like another one; distinct and dark.
// clang-format off
constexpr std::array<std::uint32_t, 10> kOthers = {0x0072B2, 0xD55E00, 0x8844AA, 0x222222, 0x56B4E9,
                                                   0xAA1144, 0x8B5A2B, 0xE377C2, 0x117733, 0xB8860B};
// clang-format on

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
Vector3d lab(std::uint32_t rgb) {
  Eigen::Matrix3d M;
  M << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  const Vector3d white(0.9505, 1, 1.089);
  const Vector3d xyz = M * Vector3d(linear(red(rgb)), linear(green(rgb)), linear(blue(rgb)));
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
  const Vector3d g = xyz.cwiseQuotient(white).unaryExpr(f);
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
        style.marker = curve.marker.value_or(next++) % kMarkerShapes;
        style.dashes = dashes_of(turns[*style.marker]++);
      }
      styles.push_back(std::move(style));
    }
  return styles;
}

FigureLayout lay_out(const Figure& figure,
                     const std::vector<CurveStyle>& styles,
                     const FigureSheet& sheet) {
  const double s = sheet.scale;
  const FigureType& type = sheet.type;
  FigureLayout layout;
  layout.width = sheet.width;
  const double room = sheet.width - 2 * kMargin * s;
  layout.title = wrapped(figure.title, type.title, true, room);
  layout.note = wrapped(figure.note, type.note, false, room);
  const double lines = kLineSpacing * type.title * static_cast<double>(layout.title.size());
  layout.title_y = kMargin * s + kLineSpacing * type.title / 2;
  const double top = kMargin * s + lines;
  for (const CurveStyle& style : styles)
    if (is_shown(figure, style.name)) layout.keys.push_back({&style, style.name});
  if (has_few_windows(figure))
    layout.keys.push_back({nullptr, fmt::format("fewer than {} windows", kFewWindows)});
  const double legend_height = place_keys(layout.keys, paper_style(sheet).legend, room, 0.5);
  const double note_height = kLineSpacing * type.note * static_cast<double>(layout.note.size());
  const double below = legend_height + note_height + (layout.note.empty() ? 1 : 1.6) * kMargin * s;
  const auto charts = static_cast<int>(figure.charts.size());
  const int columns = std::clamp(sheet.columns, 1, std::max(1, charts));
  const int rows = std::max(1, (charts + columns - 1) / columns);
  const double head = 2.1 * type.chart_title;
  const double foot = 0.5 * type.tick + 8 * s + type.tick + 2.2 * type.axis_title;
  double height = kFreeHeight * s;
  if (sheet.height) height = std::max(20 * s, (*sheet.height - top - below) / rows - head - foot);
  const double left = 3.3 * type.tick + 2 * type.axis_title, right = 1.3 * type.tick;
  const double column = sheet.width / columns;
  for (int i = 0; i < charts; ++i) {
    const int row = i / columns;
    layout.axes.emplace_back(std::round(column * (i % columns) + left),
                             std::round(top + head + (head + height + foot) * row),
                             std::max(20 * s, std::round(column - left - right)),
                             std::round(height));
  }
  const double end = top + rows * (head + height + foot);
  for (LegendKey& key : layout.keys) key.at += Vector2d(kMargin * s, end);
  layout.note_y = end + legend_height + 0.6 * kMargin * s + kLineSpacing * type.note / 2;
  layout.height = sheet.height.value_or(std::ceil(end + below));
  return layout;
}

cv::Size default_figure_size(const Figure& figure) {
  return {chart_count(figure) * kChartWidth, kChartHeight + 40};
}

FigureSheet screen_sheet(const Figure& figure, cv::Size size) {
  const int columns = chart_count(figure);
  const double width = size.width, height = size.height;
  const double fitting = std::min(width / (columns * kChartWidth), height / kChartHeight);
  const double s = std::clamp(fitting, 0.5, 8.0);
  FigureType type;
  for (double* one :
       {&type.title, &type.chart_title, &type.axis_title, &type.tick, &type.legend, &type.note})
    *one *= s;
  return {.width = width, .height = height, .scale = s, .columns = columns, .type = type};
}

FigureSheet printed_sheet(const Figure& figure, double width_mm) {
  constexpr double kUnit_mm = 25.4 / 72 / 2;  // half a point: 14 units are 7 pt
  constexpr double kNarrowest = 300;          // chart width
  const double width = width_mm / kUnit_mm;
  const int columns = std::clamp(static_cast<int>(width / kNarrowest), 1, chart_count(figure));
  const FigureType type{16, 15, 14.5, 14, 14, 14};
  return {.width = width, .columns = columns, .type = type, .unit_mm = kUnit_mm};
}

cv::Mat figure_image(const Figure& figure, const FigureSheet& sheet, double px_per_unit) {
  const PlacedFigure placed{figure, sheet};
  const FigureLayout& layout = placed.layout;
  const cv::Size size(cvRound(layout.width * px_per_unit), cvRound(layout.height * px_per_unit));
  return drawn_image(size, px_per_unit, kWhite, [&](cairo_t& cairo) { placed.draw(cairo); });
}

std::string figure_svg(const Figure& figure, const FigureSheet& sheet) {
  const PlacedFigure placed{figure, sheet};
  std::string svg;
  cairo_surface_t* surface = cairo_svg_surface_create_for_stream(
      append_bytes, &svg, placed.width_pt(), placed.height_pt());
  cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PT);
  draw_on(surface, placed.points_per_unit(), [&](cairo_t& cairo) {
    cairo_set_source_rgb(&cairo, 1, 1, 1);
    cairo_paint(&cairo);
    placed.draw(cairo);
  });
  // Cairo numbers surfaces through the whole run.
  const std::string_view name = "id=\"surface";
  if (const std::size_t id = svg.find(name); id != std::string::npos)
    svg.erase(id + name.size(), svg.find('"', id + name.size()) - id - name.size());
  const std::size_t begin = svg.find('>', svg.find("<svg")) + 1;
  const std::string title = escaped(figure.title), content = escaped(description(figure));
  return svg.insert(begin, fmt::format("\n<title>{}</title>\n<desc>{}</desc>", title, content));
}

std::string figure_pdf(const Figure& figure, const FigureSheet& sheet) {
  const PlacedFigure placed{figure, sheet};
  std::string pdf;
  cairo_surface_t* surface = cairo_pdf_surface_create_for_stream(
      append_bytes, &pdf, placed.width_pt(), placed.height_pt());
  cairo_pdf_surface_restrict_to_version(surface, CAIRO_PDF_VERSION_1_4);
  const std::string title = legible(figure.title, 4 * figure.title.size());
  cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, title.c_str());
  // By default Cairo writes the present time.
  cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "2026-01-01T00:00:00Z");
  draw_on(surface, placed.points_per_unit(), [&](cairo_t& cairo) { placed.draw(cairo); });
  return pdf;
}

cv::Mat draw_figure(const Figure& figure, cv::Size size) {
  return figure_image(figure, screen_sheet(figure, size));
}

}  // namespace gpo
