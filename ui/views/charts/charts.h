// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "engine/inspection/studies/studies.h"
#include "ui/views/overlay/overlay.h"

#include <cairo.h>

namespace gpo {

/// Points of a line or corners of a polygon, y down.
using Polyline = std::vector<Vector2d>;

/// A color, 0xRRGGBB, and its opacity, 0 to 1.
struct Ink {
  std::uint32_t rgb = 0;
  double opacity = 1;
};

struct Pen {
  double width = 1;
  Ink ink;
  std::vector<double> dashes = {};  ///< lengths of dashes and gaps in turn; empty: solid
  double phase = 0;                 ///< offset of the pattern at the line's start
  bool round = false;               ///< ends of dashes; makes a dot of a dash of length 0
};

void fill_polygon(cairo_t& cairo, const Polyline& outline, const Ink& ink);
void stroke_line(cairo_t& cairo, const Polyline& line, const Pen& pen);
/// Draws a horizontal or vertical line, in images at whole pixels, so that it is sharp.
void stroke_straight(cairo_t& cairo, const Vector2d& from, const Vector2d& to, const Pen& pen);

constexpr int kMarkerShapes = 10;
/// Returns the outline of a marker around a point; all have about the same visual weight.
Polyline marker_shape(int index, const Vector2d& center, double size);

enum class Anchor { begin, middle, end };

struct TextFormat {
  double size = 14;  ///< em size
  std::uint32_t rgb = 0;
  Anchor anchor = Anchor::middle;
  bool bold = false;
  bool upwards = false;  ///< rotated by 90 degrees about its place
};

/// Draws text at its anchor and the middle of its capitals; selectable in PDF, else as outlines.
void draw_text(cairo_t& cairo,
               const std::string& text,
               const Vector2d& at,
               const TextFormat& style);

/// Returns the width of a text [units of `size`].
double width_of(const std::string& text, double size, bool bold = false);

/// Breaks a text into lines not wider than `room`, unless a single word is.
std::vector<std::string> wrapped(const std::string& text, double size, bool bold, double room);

using CairoDraw = std::function<void(cairo_t& cairo)>;

/// Draws on a surface and destroys it. Throws std::runtime_error with Cairo's message.
void draw_on(cairo_surface_t* surface, double scale, const CairoDraw& draw);

/// Returns the image drawn by `draw`, CV_8UC3, BGR; the same bytes at every call.
cv::Mat drawn_image(cv::Size size, double scale, std::uint32_t ground, const CairoDraw& draw);

struct AxisTicks {
  double low = 0, high = 1;
  std::vector<double> values;
  std::vector<std::string> labels;  ///< one per value
};

/// Returns at least three, about `most` ticks at multiples of 1, 2 or 5 times a power of ten.
AxisTicks linear_ticks(double low, double high, int most);

/// Extends the range, > 0, to 1, 2 or 5 times a power of ten. Ticks are at such numbers, only at
/// (some) powers of ten if that is enough, at linear steps if there would be fewer than three.
AxisTicks logarithmic_ticks(double low, double high, int most);

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
  Vector2d px(double x, double y) const { return {x_px(x), y_px(y)}; }
  double x_value(double px) const { return x_low + (x_high - x_low) * (px - left) / width; }
  bool inside(const Vector2d& point_px) const {
    const double u = (point_px.x() - left) / width, v = (point_px.y() - bottom) / height;
    return u >= 0 && u <= 1 && v >= 0 && v <= 1;
  }
};

/// Style of the curves of one name, in all charts and the legend of a figure.
struct CurveStyle {
  std::string name;
  std::uint32_t rgb = 0;
  bool dotted = false;
  std::vector<double> dashes = {};           ///< and gaps in turn, at scale 1 [px]; empty: solid
  std::optional<int> marker = std::nullopt;  ///< index for `marker_shape`; on the screen a circle
  double marker_px = 9;                      ///< at scale 1
};

/// Sizes of a legend [units].
struct LegendStyle {
  double sample = 40, beside = 8,
         between = 26;  ///< widths: a sample, the gaps after it and its text
  double row = 25.5, text_size = 15;
};

/// Style of a chart, in the window or on paper [units].
struct ChartStyle {
  std::uint32_t ground, text, tick_text, dim, axis, grid;
  double scale = 1;                       ///< for lines, markers and gaps
  double text_size = 15, tick_size = 14;  ///< em sizes
  double x_spacing = 50, y_spacing = 31;  ///< smallest distances of ticks
  bool dashes_coinciding = false;         ///< dashes a curve over an equal one, to show both
  LegendStyle legend = {};
};

/// Draws all but titles. `axes` is between the axes' ends, `styles` has one entry per name.
ChartMapping draw_chart(cairo_t& cairo,
                        const Chart& chart,
                        const std::vector<CurveStyle>& styles,
                        const cv::Rect2d& axes,
                        const ChartStyle& look);

/// An entry of a legend: a sample of a curve, or a hollow point, and its meaning.
struct LegendKey {
  const CurveStyle* style = nullptr;  ///< null: a hollow point
  std::string text;
  Vector2d at = Vector2d::Zero();  ///< the sample's left end; the text is beside it
};

double width_of(const std::vector<LegendKey>& keys, const LegendStyle& look);

/// Places entries in rows up to `room` from (0, 0). `align`: 0 left, 1 right. Returns their height.
double place_keys(std::vector<LegendKey>& keys, const LegendStyle& look, double room, double align);

void draw_key(cairo_t& cairo, const LegendKey& key, const ChartStyle& look);

struct ChartRequest {
  Chart chart;
  cv::Size size;     ///< [px]
  double scale = 1;  ///< for lines and text [px of 96 dpi]
  bool legend = true;
  Theme theme = Theme::dark;
};

struct ChartImage {
  cv::Mat bgr;
  ChartMapping mapping;  ///< [px from the upper left corner, y down]
};

ChartImage draw_window_chart(const ChartRequest& request);

/// A chart of the window in graphics memory. Needs its context to be current.
class ChartView {
 public:
  /// Draws only after a change. The size must not be empty.
  void update(const ChartRequest& request);

  const ImageTexture& texture() const { return texture_; }
  const ChartMapping& mapping() const { return mapping_; }

 private:
  ChartRequest shown_;
  ChartMapping mapping_;
  ImageTexture texture_;
};

/// Draws the chart into the window in the current theme. Returns its mapping to the screen [px].
ChartMapping draw_chart_view(const Area& area, ChartView& view, const Chart& chart, bool legend);

void draw_chart_cursor(ImDrawList& list, const ChartMapping& to, double x, std::uint32_t rgb);

/// Lists the curves' values nearest to `x`, one per line, below the value of the x axis.
std::string chart_values_at(const Chart& chart, double x);

/// Returns a line per point: the curve's name, x, y, and its band. Unknown values are empty.
std::string to_csv(const Chart& chart);

/// Residuals of inliers [px] by frame of the window, zero in the reference frame; empty if failed.
using WindowResiduals = std::vector<std::vector<double>>;
WindowResiduals window_residuals(const Inspection& inspection);

/// Returns histograms of the residuals of the window and of a frame (counted in the recording) [%].
Chart residual_histogram(const WindowResiduals& residuals,
                         const Inspection& inspection,
                         int frame,
                         bool logarithmic = false);

/// Returns the RMS residual over the frames, and the residuals of a track (null: none).
Chart rms_chart(const WindowResiduals& residuals, const Inspection& shown, const TrackLife* track);

/// Returns cost, gradient and step over the iterations of the results with a trace, the first one
/// over the others.
std::array<Chart, 3> solver_charts(std::span<const ShownResult> results);

/// Returns one style per name: equal markers differ in dashes, similar colors are replaced.
std::vector<CurveStyle> curve_styles(const Figure& figure);

/// Returns the CIE 1976 difference of two colors: 2 is barely visible, 100 is black on white.
double color_difference(std::uint32_t a, std::uint32_t b);

/// Sizes of a figure's text [units].
struct FigureType {
  double title = 19, chart_title = 16, axis_title = 15, tick = 14, legend = 15, note = 13;
};

/// The sheet of a figure [units].
struct FigureSheet {
  double width = 0;
  std::optional<double> height = {};  ///< nullopt: as high as the content
  double scale = 1;                   ///< for lines, markers and gaps
  int columns = 1;                    ///< charts per row
  FigureType type = {};
  double unit_mm = 25.4 / 96;  ///< on paper; by default a unit is a pixel of 96 dpi
};

/// Places of a figure's parts, y down [units].
struct FigureLayout {
  double width = 0, height = 0;
  std::vector<cv::Rect2d> axes;  ///< one per chart
  std::vector<std::string> title, note;
  double title_y = 0, note_y = 0;  ///< middle of the first line
  std::vector<LegendKey> keys;     ///< they point to the styles
};
FigureLayout lay_out(const Figure& figure,
                     const std::vector<CurveStyle>& styles,
                     const FigureSheet& sheet);

cv::Size default_figure_size(const Figure& figure);

/// Returns a sheet of pixels: charts side by side, one legend and the note below.
FigureSheet screen_sheet(const Figure& figure, cv::Size size);

/// Returns a sheet for a page, as high as its content, with text of at least 7 pt.
FigureSheet printed_sheet(const Figure& figure, double width_mm);

// Figures are white. Curves differ in markers and dashes besides colors; points of few windows are
// hollow, many bands are outlined, bounds are dotted. The same figure gives the same bytes.

/// Returns pixels, CV_8UC3, BGR.
cv::Mat figure_image(const Figure& figure, const FigureSheet& sheet, double px_per_unit = 1);

/// Returns SVG with text as outlines; its title and description name the content.
std::string figure_svg(const Figure& figure, const FigureSheet& sheet);

/// Returns a page of PDF with selectable text and its fonts.
std::string figure_pdf(const Figure& figure, const FigureSheet& sheet);

/// Draws the figure on a `screen_sheet`.
cv::Mat draw_figure(const Figure& figure, cv::Size size);

}  // namespace gpo
