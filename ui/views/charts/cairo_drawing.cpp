// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "ui/views/charts/charts.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include <cairo-ft.h>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr double kCapHeight = 0.727;  ///< in the program's fonts [em]

struct Release {
  void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_font_options_t* options) const { cairo_font_options_destroy(options); }
};
template <class T>
using Owned = std::unique_ptr<T, Release>;

/// Without hints, so that shapes are the same at all sizes.
Owned<cairo_font_options_t> font_options() {
  Owned<cairo_font_options_t> options(cairo_font_options_create());
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  return options;
}

cairo_font_face_t* load_font(std::string_view font) {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  const auto* bytes = reinterpret_cast<const FT_Byte*>(font.data());
  if (FT_Init_FreeType(&library) != 0 ||
      FT_New_Memory_Face(library, bytes, static_cast<FT_Long>(font.size()), 0, &face) != 0)
    throw std::runtime_error("FreeType cannot read the embedded font");
  return cairo_ft_font_face_create_for_ft_face(face, FT_LOAD_NO_HINTING);
}

/// Both fonts stay loaded: Cairo caches glyphs by font.
cairo_font_face_t* font_face(bool bold) {
  static cairo_font_face_t* const kRegular = load_font(font_file(false));
  static cairo_font_face_t* const kBold = load_font(font_file(true));
  return bold ? kBold : kRegular;
}

/// Escapes bytes that are not UTF-8, on which Cairo fails.
std::string clean(const std::string& text) { return legible(text, 4 * text.size()); }

bool is_image(cairo_t& cairo) {
  return cairo_surface_get_type(cairo_get_target(&cairo)) == CAIRO_SURFACE_TYPE_IMAGE;
}

void set_ink(cairo_t& cairo, const Ink& ink) {
  cairo_set_source_rgba(&cairo, red(ink.rgb), green(ink.rgb), blue(ink.rgb), ink.opacity);
}

void add_path(cairo_t& cairo, const Polyline& points) {
  cairo_new_path(&cairo);
  for (const Vector2d& point : points) cairo_line_to(&cairo, point.x(), point.y());
}

/// A marker with tips around its center, and dents between them.
struct Shape {
  int tips;
  double first_deg;  ///< direction of the first tip, 90: up
  double radius;     ///< distance of the tips [half sizes of the marker]
  double dent;       ///< radius of the dents [radii of the tips]; 0: none
};

constexpr std::array<Shape, kMarkerShapes> kShapes{{
    {24, 0, 1.0, 0},      // circle
    {4, 45, 1.25, 0},     // square
    {3, 90, 1.35, 0},     // triangle
    {4, 90, 1.3, 0},      // diamond
    {3, -90, 1.35, 0},    // inverted triangle
    {5, 90, 1.45, 0.42},  // star
    {4, 45, 1.4, 0.32},   // cross
    {6, 90, 1.15, 0},     // hexagon
    {4, 90, 1.5, 0.32},   // plus
    {3, 90, 1.5, 0.32},   // three-pointed star
}};

}  // namespace

void fill_polygon(cairo_t& cairo, const Polyline& outline, const Ink& ink) {
  set_ink(cairo, ink);
  add_path(cairo, outline);
  cairo_fill(&cairo);
}

void stroke_line(cairo_t& cairo, const Polyline& line, const Pen& pen) {
  set_ink(cairo, pen.ink);
  cairo_set_line_width(&cairo, pen.width);
  cairo_set_dash(&cairo, pen.dashes.data(), static_cast<int>(pen.dashes.size()), pen.phase);
  cairo_set_line_cap(&cairo, pen.round ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
  cairo_set_line_join(&cairo, CAIRO_LINE_JOIN_ROUND);
  add_path(cairo, line);
  cairo_stroke(&cairo);
}

void stroke_straight(cairo_t& cairo, const Vector2d& from, const Vector2d& to, const Pen& pen) {
  if (!is_image(cairo)) return stroke_line(cairo, {from, to}, pen);
  Polyline line = {from, to};
  double width = pen.width, unused = 0;
  cairo_user_to_device_distance(&cairo, &width, &unused);
  width = std::max(1.0, std::round(width));
  const double middle = std::fmod(width, 2) / 2;
  for (Vector2d& end : line) {
    cairo_user_to_device(&cairo, &end.x(), &end.y());
    end = (end.array() - middle).round() + middle;
    cairo_device_to_user(&cairo, &end.x(), &end.y());
  }
  cairo_device_to_user_distance(&cairo, &width, &unused);
  stroke_line(cairo, line, {width, pen.ink});
}

void draw_text(cairo_t& cairo,
               const std::string& text,
               const Vector2d& at,
               const TextFormat& style) {
  const double share = style.anchor == Anchor::begin ? 0 : style.anchor == Anchor::middle ? 0.5 : 1;
  cairo_save(&cairo);
  cairo_translate(&cairo, at.x(), at.y());
  if (style.upwards) cairo_rotate(&cairo, -std::numbers::pi / 2);
  set_ink(cairo, {style.rgb});
  cairo_set_font_options(&cairo, font_options().get());
  cairo_set_font_face(&cairo, font_face(style.bold));
  cairo_set_font_size(&cairo, style.size);
  cairo_move_to(
      &cairo, -share * width_of(text, style.size, style.bold), kCapHeight / 2 * style.size);
  // Cairo 1.16 moves glyphs in images to whole pixels, but not outlines.
  if (is_image(cairo)) {
    cairo_text_path(&cairo, clean(text).c_str());
    cairo_fill(&cairo);
  } else {
    cairo_show_text(&cairo, clean(text).c_str());
  }
  cairo_restore(&cairo);
}

double width_of(const std::string& text, double size, bool bold) {
  constexpr double kMeasured = 1000;
  cairo_matrix_t font, device;
  cairo_matrix_init_scale(&font, kMeasured, kMeasured);
  cairo_matrix_init_identity(&device);
  cairo_scaled_font_t* scaled =
      cairo_scaled_font_create(font_face(bold), &font, &device, font_options().get());
  cairo_text_extents_t extents;
  cairo_scaled_font_text_extents(scaled, clean(text).c_str(), &extents);
  cairo_scaled_font_destroy(scaled);
  return extents.x_advance * size / kMeasured;
}

std::vector<std::string> wrapped(const std::string& text, double size, bool bold, double room) {
  return wrapped(text, [&](const auto& line) { return width_of(line, size, bold) <= room; });
}

void draw_on(cairo_surface_t* surface, double scale, const CairoDraw& draw) {
  const Owned<cairo_surface_t> owned(surface);
  const Owned<cairo_t> cairo(cairo_create(surface));
  cairo_scale(cairo.get(), scale, scale);
  draw(*cairo);
  cairo_surface_finish(surface);
  for (const cairo_status_t status : {cairo_status(cairo.get()), cairo_surface_status(surface)})
    if (status != CAIRO_STATUS_SUCCESS)
      throw std::runtime_error(fmt::format("Cairo: {}", cairo_status_to_string(status)));
}

cv::Mat drawn_image(cv::Size size, double scale, std::uint32_t ground, const CairoDraw& draw) {
  cv::Mat pixels(size, CV_8UC4);
  draw_on(cairo_image_surface_create_for_data(
              pixels.data, CAIRO_FORMAT_RGB24, size.width, size.height, 4 * size.width),
          scale,
          [&](cairo_t& cairo) {
            set_ink(cairo, {ground});
            cairo_paint(&cairo);
            draw(cairo);
          });
  cv::Mat bgr;
  cv::cvtColor(pixels, bgr, cv::COLOR_BGRA2BGR);
  return bgr;
}

Polyline marker_shape(int index, const Vector2d& center, double size) {
  const Shape& shape = kShapes[index % kMarkerShapes];
  const int corners = shape.dent > 0 ? 2 * shape.tips : shape.tips;
  Polyline outline;
  for (int i = 0; i < corners; ++i) {
    const double angle = (shape.first_deg + 360.0 * i / corners) * std::numbers::pi / 180;
    const bool dented = shape.dent > 0 && i % 2 == 1;
    const double radius = size / 2 * shape.radius * (dented ? shape.dent : 1);
    outline.push_back(center + radius * Vector2d(std::cos(angle), -std::sin(angle)));
  }
  return outline;
}

}  // namespace gpo
