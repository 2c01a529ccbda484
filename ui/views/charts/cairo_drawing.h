// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <cairo.h>
#include <opencv2/core.hpp>

namespace gpo {

/// Points of a line or corners of a polygon, y down.
using Polyline = std::vector<Eigen::Vector2d>;

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
void stroke_straight(cairo_t& cairo,
                     const Eigen::Vector2d& from,
                     const Eigen::Vector2d& to,
                     const Pen& pen);

constexpr int kMarkerShapes = 10;
/// Returns the outline of a marker around a point; all have about the same visual weight.
Polyline marker_shape(int index, const Eigen::Vector2d& center, double size);

enum class Anchor { begin, middle, end };

struct TextFormat {
  double size = 14;  ///< em size
  std::uint32_t rgb = 0;
  Anchor anchor = Anchor::middle;
  bool bold = false;
  bool upwards = false;  ///< rotated by 90 degrees about its place
};

/// Draws a line of text in the program's font: selectable in PDF, as outlines in SVG and images.
/// `at` is the anchor along the text and the middle of the capitals across it.
void draw_text(cairo_t& cairo,
               const std::string& text,
               const Eigen::Vector2d& at,
               const TextFormat& style);

/// Returns the width of a text [units of `size`].
double width_of(const std::string& text, double size, bool bold = false);

/// Breaks a text into lines not wider than `room`, unless a single word is.
std::vector<std::string> wrapped(const std::string& text, double size, bool bold, double room);

using CairoDraw = std::function<void(cairo_t& cairo)>;

/// Draws on a surface, which it owns then, with `scale` device units per unit. Throws
/// std::runtime_error with Cairo's message if it fails.
void draw_on(cairo_surface_t* surface, double scale, const CairoDraw& draw);

/// Returns the image drawn by `draw`, CV_8UC3, BGR; the same bytes at every call.
cv::Mat drawn_image(cv::Size size, double scale, std::uint32_t ground, const CairoDraw& draw);

}  // namespace gpo
