// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/views/figures/drawing.h"

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A piece of an outline: a new contour's begin, a line, or a cubic Bezier curve to the last point.
struct OutlinePiece {
  enum class Kind { move, line, cubic } kind = Kind::move;
  std::array<Eigen::Vector2d, 3> points;  ///< the last of them only, but for a curve
};

/// The outlines of a text's glyphs where it stands in its drawing; inside is what an odd number of
/// contours goes around.
std::vector<OutlinePiece> outlines_of(const Text& text);

/// How wide a text is [units of `size`].
double width_of(const std::string& text, double size, bool bold = false);

/// Words in lines that are not wider than `room`, where no single word is.
std::vector<std::string> wrapped(const std::string& text, double size, bool bold, double room);

/// Of the em: the height of the program's capitals.
constexpr double kCapHeight = 0.727;

}  // namespace gpo
