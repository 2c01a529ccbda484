// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/look/zoom.h"

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

struct ImDrawList;
struct ImVec2;

namespace gpo {

/// Signs that stand for data, in the views and in their legends alike.
enum class Sign { none, circle, cross, dot, line, square, frustum, disc, triangle };

struct LegendRow {
  Sign sign;
  std::uint32_t rgb;
  std::string text;
};

enum class Corner { top_left, top_right, bottom_left, bottom_right };

ImVec2 to_imgui(const Eigen::Vector2d& point);

/// Pixels a unit of a 96 dpi screen, from the size of the current font.
float overlay_scale();

/// One sign around `center`, with a dark rim that sets it off from any picture.
void draw_sign(ImDrawList& list, Sign sign, const ImVec2& center, std::uint32_t rgb);

/// A row's sign, its center `sign_px` right of `at`, and its text, the upper left corner `text_px`
/// right of it; a row without a sign begins at once.
void draw_legend_row(ImDrawList& list,
                     const ImVec2& at,
                     const LegendRow& row,
                     float sign_px,
                     float text_px,
                     std::uint32_t text_rgb = color_of(Role::text));

/// A heading (may be empty) and rows on a dark, translucent ground in a corner of the rectangle.
/// Returns what it covers.
ScreenRect draw_legend(ImDrawList& list,
                       const ScreenRect& rect,
                       Corner corner,
                       const std::string& heading,
                       const std::vector<LegendRow>& rows);

/// The rows side by side on a strip along the lower edge of the rectangle; as many lines as it
/// takes.
void draw_legend_strip(ImDrawList& list,
                       const ScreenRect& rect,
                       const std::vector<LegendRow>& rows);

/// A message in a colored frame, wrapped, at the lower middle of the rectangle.
void draw_badge(ImDrawList& list,
                const ScreenRect& rect,
                std::uint32_t rgb,
                const std::string& heading,
                const std::string& text);

/// One line from its upper left corner on, on whole pixels.
void write_text(ImDrawList& list,
                Font which,
                const Eigen::Vector2d& at,
                const std::string& text,
                std::uint32_t rgb = color_of(Role::text));

/// [px]
double text_width(Font which, const std::string& text);

/// The first of the texts that is not wider; else the last one, cut.
std::string fitting_text(Font which, std::initializer_list<std::string> texts, double width);

/// Points every `spacing` along a polyline, from its start on.
std::vector<Eigen::Vector2d> points_along(std::span<const Eigen::Vector2d> line, double spacing);

/// The pieces of a polyline that lie under a pattern of lengths, drawn and left out in turn, over
/// and over. Bends within a piece are kept: two points a straight piece.
std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> dashes_along(
    std::span<const Eigen::Vector2d> line, std::span<const double> pattern);

}  // namespace gpo
