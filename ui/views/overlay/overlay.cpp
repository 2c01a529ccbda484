// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/overlay/overlay.h"

#include "ui/context/gui.h"
#include "ui/context/theme.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <imgui.h>

namespace gpo {

namespace {

constexpr float kFontSize = 16;   // of Font::regular at 96 dpi
constexpr double kGround = 0.78;  // opacity behind text

struct TextSize {
  float width, height;
};

TextSize measure(Font which, const std::string& text) {
  const ImFont* f = font(which);
  const ImVec2 size = f->CalcTextSizeA(f->FontSize, 1e6F, 0, text.c_str());
  return {size.x, size.y};
}

/// Lines broken at spaces only; Dear ImGui would break numbers at their point.
std::string wrapped(Font which, const std::string& text, float width) {
  std::string lines, line;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    std::string longer = line;
    if (!longer.empty()) longer += ' ';
    longer += word;
    if (!line.empty() && measure(which, longer).width > width) {
      lines += line;
      lines += '\n';
      line = word;
    } else {
      line = longer;
    }
  }
  return lines + line;
}

void draw_ground(ImDrawList& list, const ImVec2& min, const ImVec2& max, std::uint32_t frame_rgb) {
  const float scale = overlay_scale();
  list.AddRectFilled(min, max, imgui_color(Role::background, kGround), 5 * scale);
  list.AddRect(min, max, imgui_color(frame_rgb, 0.9), 5 * scale, 0, scale);
}

/// A tenth of a pixel off a circle of `Sign::circle`'s size at most.
int circle_sides(float scale) { return static_cast<int>(std::ceil(13 * std::sqrt(scale))); }

void draw_frustum_sign(ImDrawList& list, const ImVec2& c, float scale, ImU32 color) {
  const ImVec2 apex(c.x - 5 * scale, c.y);
  const ImVec2 top(c.x + 5 * scale, c.y - 5 * scale), bottom(c.x + 5 * scale, c.y + 5 * scale);
  list.AddTriangle(apex, top, bottom, color, 1.6F * scale);
}

}  // namespace

ImVec2 to_imgui(const Eigen::Vector2d& point) {
  return {static_cast<float>(point.x()), static_cast<float>(point.y())};
}

float overlay_scale() { return font(Font::regular)->FontSize / kFontSize; }

void draw_sign(ImDrawList& list, Sign sign, const ImVec2& c, std::uint32_t rgb) {
  const float s = overlay_scale();
  const ImU32 color = imgui_color(rgb);
  const ImU32 rim = imgui_color(Role::background, 0.55);
  switch (sign) {
    case Sign::circle:
      // As many sides as tell it from a circle at its size: there are hundreds in a picture.
      list.AddCircle(c, 3.8F * s, rim, circle_sides(s), 3.4F * s);
      list.AddCircle(c, 3.8F * s, color, circle_sides(s), 1.6F * s);
      break;
    case Sign::cross:
      for (const auto& [paint, width] : {std::pair{rim, 3.6F}, std::pair{color, 1.8F}}) {
        const float r = 3.6F * s;
        list.AddLine(ImVec2(c.x - r, c.y - r), ImVec2(c.x + r, c.y + r), paint, width * s);
        list.AddLine(ImVec2(c.x - r, c.y + r), ImVec2(c.x + r, c.y - r), paint, width * s);
      }
      break;
    case Sign::dot:
      list.AddCircleFilled(c, 2.6F * s, color, 16);
      break;
    case Sign::line:
      list.AddLine(ImVec2(c.x - 7 * s, c.y), ImVec2(c.x + 7 * s, c.y), color, 2 * s);
      break;
    case Sign::square:
      list.AddRect(ImVec2(c.x - 5 * s, c.y - 5 * s),
                   ImVec2(c.x + 5 * s, c.y + 5 * s),
                   color,
                   0,
                   0,
                   1.8F * s);
      break;
    case Sign::frustum:
      draw_frustum_sign(list, c, s, color);
      break;
    case Sign::disc:
      list.AddCircleFilled(c, 4.6F * s, color, 20);
      break;
    case Sign::triangle:
      list.AddTriangleFilled(ImVec2(c.x, c.y - 5 * s),
                             ImVec2(c.x + 5.4F * s, c.y + 4.4F * s),
                             ImVec2(c.x - 5.4F * s, c.y + 4.4F * s),
                             color);
      break;
    case Sign::none:
      break;
  }
}

void draw_legend_row(ImDrawList& list,
                     const ImVec2& at,
                     const LegendRow& row,
                     float sign_px,
                     float text_px,
                     std::uint32_t text_rgb) {
  const ImFont* f = font(Font::small);
  const bool sign = row.sign != Sign::none;
  if (sign) draw_sign(list, row.sign, ImVec2(at.x + sign_px, at.y + f->FontSize / 2), row.rgb);
  const ImVec2 text(at.x + (sign ? text_px : 0), at.y);
  list.AddText(f, f->FontSize, text, imgui_color(text_rgb), row.text.c_str());
}

ScreenRect draw_legend(ImDrawList& list,
                       const ScreenRect& rect,
                       Corner corner,
                       const std::string& heading,
                       const std::vector<LegendRow>& rows) {
  const float s = overlay_scale();
  const float padding = 9 * s, margin = 10 * s, sign_width = 22 * s, gap = 4 * s;
  const float line = font(Font::small)->FontSize + gap;
  float width = heading.empty() ? 0 : measure(Font::bold, heading).width;
  for (const LegendRow& row : rows) {
    const float indent = row.sign == Sign::none ? 0 : sign_width;
    width = std::max(width, indent + measure(Font::small, row.text).width);
  }
  const float top = heading.empty() ? 0 : font(Font::bold)->FontSize + gap;
  const ImVec2 size(width + 2 * padding,
                    top + line * static_cast<float>(rows.size()) - gap + 2 * padding);
  const bool right = corner == Corner::top_right || corner == Corner::bottom_right;
  const bool bottom = corner == Corner::bottom_left || corner == Corner::bottom_right;
  const ImVec2 low = to_imgui(rect.min), high = to_imgui(rect.min + rect.size);
  const ImVec2 min(std::round(right ? high.x - margin - size.x : low.x + margin),
                   std::round(bottom ? high.y - margin - size.y : low.y + margin));
  draw_ground(list, min, ImVec2(min.x + size.x, min.y + size.y), color_of(Role::border));
  ImVec2 at(min.x + padding, min.y + padding);
  const ImFont* bold = font(Font::bold);
  list.AddText(bold, bold->FontSize, at, imgui_color(Role::text), heading.c_str());
  at.y += top;
  for (const LegendRow& row : rows) {
    draw_legend_row(list, at, row, 7 * s, sign_width);
    at.y += line;
  }
  return {{min.x, min.y}, {size.x, size.y}};
}

void draw_legend_strip(ImDrawList& list,
                       const ScreenRect& rect,
                       const std::vector<LegendRow>& rows) {
  if (rows.empty()) return;
  const float s = overlay_scale();
  const ImFont* f = font(Font::small);
  const float padding = 8 * s, line = f->FontSize + 5 * s, sign_width = 18 * s, gap = 16 * s;
  const ImVec2 low = to_imgui(rect.min), high = to_imgui(rect.min + rect.size);
  std::vector<ImVec2> places;  // relative to the strip's corner
  ImVec2 at(padding, padding);
  for (const LegendRow& row : rows) {
    const float indent = row.sign == Sign::none ? 0 : sign_width;
    const float width = indent + measure(Font::small, row.text).width;
    if (at.x > padding && at.x + width + padding > high.x - low.x) at = {padding, at.y + line};
    places.push_back(at);
    at.x += width + gap;
  }
  const ImVec2 corner(low.x, std::round(high.y - at.y - f->FontSize - padding));
  list.AddRectFilled(corner, high, imgui_color(Role::background, kGround));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ImVec2 place(corner.x + places[i].x, corner.y + places[i].y);
    draw_legend_row(list, place, rows[i], 6 * s, sign_width);
  }
}

void draw_badge(ImDrawList& list,
                const ScreenRect& rect,
                std::uint32_t rgb,
                const std::string& heading,
                const std::string& text) {
  const float s = overlay_scale();
  const float padding = 11 * s;
  const float widest = std::max(0.86F * static_cast<float>(rect.size.x()) - 2 * padding, 80 * s);
  const std::string lines = wrapped(Font::regular, text, widest);
  const TextSize title = measure(Font::bold, heading);
  const TextSize body = lines.empty() ? TextSize{0, 0} : measure(Font::regular, lines);
  const float gap = lines.empty() ? 0 : 3 * s;
  const float width = std::max(title.width, body.width) + 2 * padding;
  const float height = title.height + gap + body.height + 2 * padding;
  const ImVec2 corner = to_imgui(rect.min + rect.size.cwiseProduct(Eigen::Vector2d(0.5, 1)));
  const float below = 26 * s;  // is the line that tells of the pixel under the pointer
  const ImVec2 min(std::round(corner.x - width / 2), std::round(corner.y - height - below));
  draw_ground(list, min, ImVec2(min.x + width, min.y + height), rgb);
  const ImVec2 at(min.x + padding, min.y + padding);
  const ImFont *bold = font(Font::bold), *regular = font(Font::regular);
  list.AddText(bold, bold->FontSize, at, imgui_color(rgb), heading.c_str());
  list.AddText(regular,
               regular->FontSize,
               ImVec2(at.x, at.y + title.height + gap),
               imgui_color(Role::text),
               lines.c_str());
}

using Eigen::Vector2d;

void write_text(
    ImDrawList& list, Font which, const Vector2d& at, const std::string& text, std::uint32_t rgb) {
  const ImFont* f = font(which);
  const ImVec2 place(std::round(static_cast<float>(at.x())),
                     std::round(static_cast<float>(at.y())));
  list.AddText(f, f->FontSize, place, imgui_color(rgb), text.c_str());
}

double text_width(Font which, const std::string& text) {
  const ImFont* f = font(which);
  return f->CalcTextSizeA(f->FontSize, 1e6F, 0, text.c_str()).x;
}

std::string fitting_text(Font which, std::initializer_list<std::string> texts, double width) {
  for (const std::string& text : texts)
    if (text_width(which, text) <= width) return text;
  std::string text = *std::prev(texts.end());
  const auto cut = [&] {
    do text.pop_back();
    while (!text.empty() && (text.back() & 0xC0) == 0x80);
  };
  while (!text.empty() && text_width(which, text + "\u2026") > width) cut();
  return text + "\u2026";
}

using Eigen::Vector2d;

std::vector<Vector2d> points_along(std::span<const Vector2d> line, double spacing) {
  std::vector<Vector2d> points;
  double next = 0;  // from the start of the segment
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vector2d step = line[i] - line[i - 1];
    const double length = step.norm();
    for (; next <= length && length > 0; next += spacing)
      points.push_back(line[i - 1] + next / length * step);
    next -= length;
  }
  return points;
}

std::vector<std::pair<Vector2d, Vector2d>> dashes_along(std::span<const Vector2d> line,
                                                        std::span<const double> pattern) {
  std::vector<std::pair<Vector2d, Vector2d>> dashes;
  std::size_t phase = 0;
  double left = pattern.front();  // of the pattern's current length
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vector2d step = line[i] - line[i - 1];
    const double length = step.norm();
    for (double at = 0; at < length;) {
      const bool bends = at + left >= length;  // before the pattern goes on
      const double end = bends ? length : at + left;
      if (phase % 2 == 0)
        dashes.emplace_back(line[i - 1] + at / length * step, line[i - 1] + end / length * step);
      left -= end - at;
      at = end;
      if (bends) continue;
      phase = (phase + 1) % pattern.size();
      left = pattern[phase];
    }
  }
  return dashes;
}

}  // namespace gpo
