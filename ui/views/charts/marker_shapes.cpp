// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/marker_shapes.h"

#include <array>
#include <cmath>
#include <numbers>

namespace gpo {
namespace {

/// Tips around the center, and between each two of them a dent.
struct Shape {
  int tips;
  double first_deg;  ///< where the first tip is, 90: up
  double radius;     ///< of the tips, of half the marker's size
  double dent;       ///< radius of the dents, of the tips'; 0: none
};

constexpr std::array kShapes{
    Shape{24, 0, 1.0, 0},      // circle
    Shape{4, 45, 1.25, 0},     // square
    Shape{3, 90, 1.35, 0},     // triangle
    Shape{4, 90, 1.3, 0},      // diamond
    Shape{3, -90, 1.35, 0},    // triangle, upside down
    Shape{5, 90, 1.45, 0.42},  // star
    Shape{4, 45, 1.4, 0.32},   // cross
    Shape{6, 90, 1.15, 0},     // hexagon
    Shape{4, 90, 1.5, 0.32},   // plus
    Shape{3, 90, 1.5, 0.32},   // star of three
};

}  // namespace

std::vector<Eigen::Vector2d> marker_shape(int index, const Eigen::Vector2d& center, double size) {
  const Shape& shape = kShapes[static_cast<std::size_t>(index) % kShapes.size()];
  const int corners = shape.dent > 0 ? 2 * shape.tips : shape.tips;
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < corners; ++i) {
    const double angle =
        shape.first_deg * std::numbers::pi / 180 + 2 * std::numbers::pi * i / corners;
    const bool dented = shape.dent > 0 && i % 2 == 1;
    const double radius = size / 2 * shape.radius * (dented ? shape.dent : 1);
    outline.push_back(center + radius * Eigen::Vector2d(std::cos(angle), -std::sin(angle)));
  }
  return outline;
}

int marker_shape_count() { return static_cast<int>(kShapes.size()); }

}  // namespace gpo
