// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// A color, 0xRRGGBB, and how much it covers what is below, 0 to 1.
struct Ink {
  std::uint32_t rgb = 0;
  double opacity = 1;
};

/// A polygon.
struct Fill {
  std::vector<Eigen::Vector2d> outline;
  Ink ink;
};

/// A line through points.
struct Stroke {
  std::vector<Eigen::Vector2d> line;
  double width = 1;
  Ink ink;
};

enum class Anchor { begin, middle, end };

/// A line of text in the program's own font, around `at`: on x as anchored, on y in the middle of
/// its capitals. Upwards: turned by 90 degrees about it.
struct Text {
  std::string text;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double size = 14;  ///< of the em
  bool bold = false;
  Anchor anchor = Anchor::middle;
  bool upwards = false;
  std::uint32_t rgb = 0;
};

/// What is drawn on a white sheet, one over the other, in units from its upper left corner, y down.
struct Drawing {
  double width = 0, height = 0;
  double unit_mm = 25.4 / 96;  ///< on paper; by default a unit is a pixel of 96 dpi
  std::vector<std::variant<Fill, Stroke, Text>> items;
};

/// Pixels, CV_8UC3, BGR; the same bytes on every machine that has the same FreeType.
cv::Mat picture_of(const Drawing& drawing, double px_per_unit);

/// SVG of the size on paper, with text as text. `title`, `description`: for who cannot see it.
std::string svg_of(const Drawing& drawing,
                   const std::string& title,
                   const std::string& description);

/// A page of PDF of the size on paper; text as outlines, so that it needs no font.
std::string pdf_of(const Drawing& drawing);

}  // namespace gpo
