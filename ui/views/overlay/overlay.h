// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/look/zoom.h"

#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

struct ImDrawList;
struct ImVec2;

namespace gpo {

/// Signs for data, the same in views and legends.
enum class Sign { none, circle, cross, dot, line, square, frustum, disc, triangle };

struct LegendRow {
  Sign sign;
  std::uint32_t rgb;
  std::string text;
};

using LegendRows = std::vector<LegendRow>;

enum class Corner { top_left, top_right, bottom_left, bottom_right };

ImVec2 to_imgui(const Eigen::Vector2d& point);

/// Returns pixels per unit of a 96 dpi screen, from the size of the current font.
float overlay_scale();

/// Draws a sign around `center`, with a dark rim to stand out on any image.
void draw_sign(ImDrawList& list, Sign sign, const ImVec2& center, std::uint32_t rgb);

/// Distances of a legend's row from its upper left corner [px].
struct RowIndent {
  float sign;  ///< to the center of the sign
  float text;  ///< to the text's upper left corner; 0 for rows without a sign
};
void draw_legend_row(ImDrawList& list,
                     const ImVec2& at,
                     const LegendRow& row,
                     const RowIndent& indent,
                     std::uint32_t text_rgb = color_of(Role::text));

/// Draws a heading (may be empty) and rows in a corner. Returns the covered rectangle.
ScreenRect draw_legend(ImDrawList& list,
                       const ScreenRect& rect,
                       Corner corner,
                       const std::string& heading,
                       const LegendRows& rows);

/// Draws the rows side by side along the rectangle's lower edge, in one or more lines.
void draw_legend_strip(ImDrawList& list, const ScreenRect& rect, const LegendRows& rows);

/// Draws a message, wrapped, in a colored frame at the lower middle of the rectangle.
void draw_badge(ImDrawList& list,
                const ScreenRect& rect,
                std::uint32_t rgb,
                const std::string& heading,
                const std::string& text);

/// Writes a line of text; `at` is its upper left corner, rounded to whole pixels.
void write_text(ImDrawList& list,
                Font which,
                const Eigen::Vector2d& at,
                const std::string& text,
                std::uint32_t rgb = color_of(Role::text));

/// Writes a line of text around `center`, with a dark rim.
void write_label(ImDrawList& list,
                 Font which,
                 const Eigen::Vector2d& center,
                 const std::string& text,
                 std::uint32_t rgb = color_of(Role::text));

Eigen::Vector2d text_size(Font which, const std::string& text);  ///< [px]
double text_width(Font which, const std::string& text);

/// Returns the first of the texts that fits; if none does, the last one, cut off.
std::string fitting_text(Font which, std::initializer_list<std::string> texts, double width);

/// Splits a polyline into straight dashes by a pattern of lengths of dashes and gaps, in turn.
std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> dashes_along(
    std::span<const Eigen::Vector2d> line, std::span<const double> pattern);

}  // namespace gpo
