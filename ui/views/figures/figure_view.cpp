// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/figures/figure_view.h"

#include "engine/base/error.h"

#include <algorithm>
#include <string_view>

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>

namespace gpo {
namespace {

// Of one chart with its titles [px], at which text has its nominal size.
constexpr int kChartWidth = 500, kChartHeight = 440;
constexpr std::uint32_t kWhite = 0xFFFFFF;

int chart_count(const Figure& figure) {
  return std::max(1, static_cast<int>(figure.charts.size()));
}

/// A figure with its layout on a sheet.
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

/// Lines of text, centered at `text.at` and below.
void write_lines(cairo_t& cairo, const std::vector<std::string>& lines, Text text) {
  for (const std::string& line : lines) {
    text.text = line;
    draw_text(cairo, text);
    text.at.y() += kLineSpacing * text.size;
  }
}

void write_titles(cairo_t& cairo,
                  const Chart& chart,
                  const cv::Rect2d& axes,
                  const FigureSheet& sheet,
                  std::uint32_t rgb) {
  const FigureType& type = sheet.type;
  const double x = axes.x + axes.width / 2, y = axes.y + axes.height / 2;
  const double below = axes.br().y + 9 * sheet.scale + 1.1 * type.tick + type.axis_title;
  const double beside = axes.x - 3.3 * type.tick - type.axis_title;
  draw_text(cairo,
            {.text = chart.title,
             .at = {x, axes.y - type.chart_title},
             .size = type.chart_title,
             .rgb = rgb,
             .bold = true});
  draw_text(cairo, {chart.x_label, {x, below}, type.axis_title, rgb});
  draw_text(cairo,
            {.text = chart.y_label,
             .at = {beside, y},
             .size = type.axis_title,
             .rgb = rgb,
             .upwards = true});
}

void PlacedFigure::draw(cairo_t& cairo) const {
  const ChartStyle look = paper_style(sheet);
  const double middle = layout.width / 2;
  write_lines(cairo,
              layout.title,
              {"", {middle, layout.title_y}, sheet.type.title, look.text, Anchor::middle, true});
  for (std::size_t i = 0; i < figure.charts.size(); ++i) {
    draw_chart(cairo, figure.charts[i], styles, layout.axes[i], look);
    write_titles(cairo, figure.charts[i], layout.axes[i], sheet, look.text);
  }
  for (const LegendKey& key : layout.keys) draw_key(cairo, key, look);
  write_lines(cairo, layout.note, {"", {middle, layout.note_y}, sheet.type.note, look.dim});
  if (figure.charts.empty())
    draw_text(cairo, {"no charts", {middle, layout.height / 2}, sheet.type.title, look.text});
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

/// As the content of an XML element.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : legible(text, 4 * text.size()))
    result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return result;
}

}  // namespace

cv::Size default_figure_size(const Figure& figure) {
  return {chart_count(figure) * kChartWidth, kChartHeight + 40};
}

FigureSheet screen_sheet(const Figure& figure, cv::Size size) {
  const int columns = chart_count(figure);
  const double s = std::clamp(
      std::min(1.0 * size.width / (columns * kChartWidth), 1.0 * size.height / kChartHeight),
      0.5,
      8.0);
  FigureType type;
  for (double* one :
       {&type.title, &type.chart_title, &type.axis_title, &type.tick, &type.legend, &type.note})
    *one *= s;
  return {1.0 * size.width, 1.0 * size.height, s, columns, type};
}

FigureSheet printed_sheet(const Figure& figure, double width_mm) {
  constexpr double kUnit_mm = 25.4 / 72 / 2;  // half a point: 14 units are type of 7 pt
  constexpr double kNarrowest = 300;          // of a chart
  const double width = width_mm / kUnit_mm;
  const int columns = std::clamp(static_cast<int>(width / kNarrowest), 1, chart_count(figure));
  return {width, std::nullopt, 1, columns, {16, 15, 14.5, 14, 14, 14}, kUnit_mm};
}

cv::Mat figure_image(const Figure& figure, const FigureSheet& sheet, double px_per_unit) {
  const PlacedFigure placed{figure, sheet};
  const cv::Size size(cvRound(placed.layout.width * px_per_unit),
                      cvRound(placed.layout.height * px_per_unit));
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
  // Cairo numbers surfaces over the whole run.
  const std::string_view name = "id=\"surface";
  if (const std::size_t id = svg.find(name); id != std::string::npos)
    svg.erase(id + name.size(), svg.find('"', id + name.size()) - id - name.size());
  const std::size_t begin = svg.find('>', svg.find("<svg")) + 1;
  return svg.insert(begin,
                    fmt::format("\n<title>{}</title>\n<desc>{}</desc>",
                                escaped(figure.title),
                                escaped(description(figure))));
}

std::string figure_pdf(const Figure& figure, const FigureSheet& sheet) {
  const PlacedFigure placed{figure, sheet};
  std::string pdf;
  cairo_surface_t* surface = cairo_pdf_surface_create_for_stream(
      append_bytes, &pdf, placed.width_pt(), placed.height_pt());
  cairo_pdf_surface_restrict_to_version(surface, CAIRO_PDF_VERSION_1_4);
  const std::string title = legible(figure.title, 4 * figure.title.size());
  cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, title.c_str());
  // Cairo writes the time of the run otherwise.
  cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "2026-01-01T00:00:00Z");
  draw_on(surface, placed.points_per_unit(), [&](cairo_t& cairo) { placed.draw(cairo); });
  return pdf;
}

cv::Mat draw_figure(const Figure& figure, cv::Size size) {
  return figure_image(figure, screen_sheet(figure, size));
}

}  // namespace gpo
