// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/context/gui.h"
#include "ui/look/navigation.h"

#include <functional>
#include <initializer_list>
#include <utility>

namespace gpo {

/// Signs for data, the same in views and legends.
enum class Sign {
  none,
  circle,
  thin_circle,
  cross,
  dot,
  line,
  square,
  frustum,
  disc,
  triangle,
  diamond
};

struct LegendRow {
  Sign sign;
  std::uint32_t rgb;
  std::string text;
  const char* toggle = "";  ///< action that shows or hides its class; empty: none
  bool off = false;         ///< the class is hidden
};

/// A row of a legend on the screen and the action that a click on it runs.
struct LegendHit {
  ScreenRect rect;
  const char* action;
};
using LegendHits = std::vector<LegendHit>;

using LegendRows = std::vector<LegendRow>;

enum class Corner { top_left, top_right, bottom_left, bottom_right };

inline ImVec2 to_imgui(const Vector2d& point) {
  return {static_cast<float>(point.x()), static_cast<float>(point.y())};
}

struct Area {
  ImDrawList& list;
  ScreenRect rect;

  ImVec2 low() const { return to_imgui(rect.min); }
  ImVec2 high() const { return to_imgui(rect.min + rect.size); }
  void fill(ImU32 color) const { list.AddRectFilled(low(), high(), color); }
  void clip() const { list.PushClipRect(low(), high(), true); }
};

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

/// Returns the place of a legend in a corner of the rectangle.
ScreenRect legend_place(const ScreenRect& rect,
                        Corner corner,
                        const std::string& title,
                        const LegendRows& rows);
/// Draws a title (may be empty) and rows in a corner.
void draw_legend(const Area& area, Corner corner, const std::string& title, const LegendRows& rows);

/// Draws the rows side by side along the rectangle's lower edge, in one or more lines.
void draw_legend_strip(const Area& area, const LegendRows& rows);

/// Draws title and rows side by side along the rectangle's upper edge, in as many lines as fit into
/// `height` but at least one, which may end with an ellipsis. The last part hides the legend.
LegendHits draw_legend_line(const Area& area,
                            double height,
                            const std::string& title,
                            const LegendRows& rows);

/// Draws a message, wrapped, in a colored frame at the lower middle of the rectangle.
void draw_badge(const Area& area,
                std::uint32_t rgb,
                const std::string& heading,
                const std::string& text);

/// Writes a line of text; `at` is its upper left corner, rounded to whole pixels.
void write_text(ImDrawList& list,
                Font which,
                const Vector2d& at,
                const std::string& text,
                std::uint32_t rgb = color_of(Role::text));

/// Writes a line of text around `center`, with a dark rim.
void write_label(ImDrawList& list,
                 Font which,
                 const Vector2d& center,
                 const std::string& text,
                 std::uint32_t rgb = color_of(Role::text));

Vector2d text_size(Font which, const std::string& text);  ///< [px]
double text_width(Font which, const std::string& text);

/// Breaks a text at spaces into lines that fit, unless a single word does not.
std::vector<std::string> wrapped(const std::string& text,
                                 const std::function<bool(const std::string& line)>& fits);

/// Returns the first of the texts that fits; if none does, the last one, cut off.
std::string fitting_text(Font which, std::initializer_list<std::string> texts, double width);

/// Splits a polyline into straight dashes by a pattern of lengths of dashes and gaps, in turn.
std::vector<std::pair<Vector2d, Vector2d>> dashes_along(std::span<const Vector2d> line,
                                                        std::span<const double> pattern);

/// Returns the numbers of the window's planes except the leading one.
std::vector<int> other_planes(const Window& window);

struct SignStyle {
  Sign sign = Sign::none;
  std::uint32_t rgb = 0;
};
/// Returns a circle in the color of the track's plane, heavier for the leading one, an outlier's
/// cross, a lost track's diamond, or the dim dot of an excluded track.
SignStyle track_style(const Inspection& inspection, int frame, int column);

/// Returns the place of a track's sign: its observation, or that of the last frame before if it is
/// lost; nullopt if it has none.
std::optional<Vector2d> place_of_sign(const Inspection& inspection, int frame, int column);

SignStyle style_of(Readiness readiness);

/// "weak, normal ±0.31°, rotation alone leaves 1.20 px where noise is 0.40 px, moved 0.1 d".
std::string verdict_text(const Verdict& verdict);

/// Windows of consecutive lengths with the same verdict.
struct VerdictRun {
  int first, last;  ///< last frames of the shortest and the longest of these windows
  Readiness readiness;
  bool operator==(const VerdictRun&) const = default;
};
std::vector<VerdictRun> verdict_runs(std::span<const Verdict> growth);

std::uint32_t viridis(double share);

/// A number per track and its color. Immutable.
struct TrackColors {
  Coloring coloring = Coloring::residual;
  bool in_meters = false;                     ///< depths, which are else in plane distances d
  std::vector<std::optional<double>> values;  ///< by column; nullopt if unknown
  double low = 0, high = 0;                   ///< 5 % and 95 % quantile: ends of the color scale

  std::uint32_t rgb(int column) const;  ///< gray if the value is unknown
};

/// Null for `Coloring::plane`, whose colors come from the window.
std::shared_ptr<const TrackColors> track_colors(const Inspection& inspection, Coloring coloring);

/// Returns the ends of the color scale with their values and units.
LegendRows legend_rows(const TrackColors& colors);

}  // namespace gpo
