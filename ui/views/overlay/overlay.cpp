// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/overlay/overlay.h"

#include "engine/inspection/studies/studies.h"

#include <algorithm>
#include <numeric>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr float kFontSize = 16;   // Font::regular at 96 dpi
constexpr double kGround = 0.78;  // opacity behind text

double text_indent(const LegendRow& row, double indent) {
  return row.sign == Sign::none ? 0 : indent;
}

void draw_ground(const Area& area, std::uint32_t frame_rgb) {
  const float s = overlay_scale();
  const ImVec2 low = area.low(), high = area.high();
  area.list.AddRectFilled(low, high, imgui_color(Role::background, kGround), 5 * s);
  area.list.AddRect(low, high, imgui_color(frame_rgb, 0.9), 5 * s, 0, s);
}

std::optional<double> value_of(const TrackLife& life, Coloring coloring) {
  if (coloring == Coloring::residual) return rms_residual_px(life);
  if (coloring == Coloring::depth) return life.depth;
  return static_cast<double>(life.frames.size());
}

std::string text_of(const TrackColors& colors, double value) {
  if (colors.coloring == Coloring::residual) return fmt::format("{:.2f} px", value);
  if (colors.coloring == Coloring::depth)
    return colors.in_meters ? length_text(value) : fmt::format("{:.2f} d", value);
  return counted(static_cast<std::size_t>(value), "frame");
}

/// Returns viridis without its darkest part, for dark images. `share` in 0..1.
std::uint32_t ramp_color(double share) { return viridis(0.3 + 0.7 * std::clamp(share, 0.0, 1.0)); }

}  // namespace

float overlay_scale() { return font(Font::regular)->FontSize / kFontSize; }

void draw_sign(ImDrawList& list, Sign sign, const ImVec2& c, std::uint32_t rgb) {
  // Marks on data grow less than text: hundreds of them would bury the image.
  const bool mark = sign == Sign::circle || sign == Sign::thin_circle || sign == Sign::cross ||
                    sign == Sign::diamond || sign == Sign::dot;
  const float s = mark ? std::sqrt(overlay_scale()) : overlay_scale();
  const ImU32 color = imgui_color(rgb);
  const ImU32 rim = imgui_color(Role::background, 0.55);
  const auto at = [&](float x, float y) { return ImVec2(c.x + x * s, c.y + y * s); };
  // Deviates from a circle by at most a tenth of a pixel: an image has hundreds of them.
  const int sides = static_cast<int>(std::ceil(13 * std::sqrt(s)));
  switch (sign) {
    case Sign::circle:
      list.AddCircle(c, 3.8F * s, rim, sides, 3.4F * s);
      return list.AddCircle(c, 3.8F * s, color, sides, 1.6F * s);
    case Sign::thin_circle:
      list.AddCircle(c, 3.8F * s, rim, sides, 2.6F * s);
      return list.AddCircle(c, 3.8F * s, color, sides, 1.1F * s);
    case Sign::cross:
      for (const auto& [paint, width] : {std::pair{rim, 3.6F}, std::pair{color, 1.8F}}) {
        list.AddLine(at(-3.6F, -3.6F), at(3.6F, 3.6F), paint, width * s);
        list.AddLine(at(-3.6F, 3.6F), at(3.6F, -3.6F), paint, width * s);
      }
      return;
    case Sign::diamond:
      list.AddQuad(at(-5, 0), at(0, -5), at(5, 0), at(0, 5), rim, 3.2F * s);
      return list.AddQuad(at(-5, 0), at(0, -5), at(5, 0), at(0, 5), color, 1.5F * s);
    case Sign::dot:
      return list.AddCircleFilled(c, 2.6F * s, color, 16);
    case Sign::line:
      return list.AddLine(at(-7, 0), at(7, 0), color, 2 * s);
    case Sign::square:
      return list.AddRect(at(-5, -5), at(5, 5), color, 0, 0, 1.8F * s);
    case Sign::frustum:
      return list.AddTriangle(at(-5, 0), at(5, -5), at(5, 5), color, 1.6F * s);
    case Sign::disc:
      return list.AddCircleFilled(c, 4.6F * s, color, 20);
    case Sign::triangle:
      return list.AddTriangleFilled(at(0, -5), at(5.4F, 4.4F), at(-5.4F, 4.4F), color);
    case Sign::none:
      return;
  }
}

void draw_legend_row(ImDrawList& list,
                     const ImVec2& at,
                     const LegendRow& row,
                     const RowIndent& indent,
                     std::uint32_t text_rgb) {
  const float middle = at.y + font(Font::small)->FontSize / 2;
  draw_sign(list, row.sign, ImVec2(at.x + indent.sign, middle), row.rgb);
  write_text(list, Font::small, {at.x + text_indent(row, indent.text), at.y}, row.text, text_rgb);
}

/// Lengths in a legend in a corner, at scale 1 [px].
constexpr float kLegendPadding = 9, kLegendGap = 4, kLegendText = 22;

ScreenRect legend_place(const ScreenRect& rect,
                        Corner corner,
                        const std::string& title,
                        const LegendRows& rows) {
  const float s = overlay_scale(), padding = kLegendPadding * s, margin = 10 * s;
  double width = text_width(Font::bold, title);
  for (const LegendRow& row : rows)
    width = std::max(width, text_indent(row, kLegendText * s) + text_width(Font::small, row.text));
  const float line = font(Font::small)->FontSize + kLegendGap * s;
  const float top = title.empty() ? 0 : font(Font::bold)->FontSize + kLegendGap * s;
  const Vector2d size(width + 2 * padding,
                      top + line * static_cast<float>(rows.size()) - kLegendGap * s + 2 * padding);
  const Vector2d far = rect.size - size - Vector2d::Constant(margin);
  const bool right = corner == Corner::top_right || corner == Corner::bottom_right;
  const bool bottom = corner == Corner::bottom_left || corner == Corner::bottom_right;
  const Vector2d from(right ? far.x() : margin, bottom ? far.y() : margin);
  return {(rect.min + from).array().round(), size};
}

void draw_legend(const Area& area,
                 Corner corner,
                 const std::string& title,
                 const LegendRows& rows) {
  const float s = overlay_scale();
  const ScreenRect place = legend_place(area.rect, corner, title, rows);
  draw_ground({area.list, place}, color_of(Role::border));
  Vector2d at = place.min + Vector2d::Constant(kLegendPadding * s);
  write_text(area.list, Font::bold, at, title);
  if (!title.empty()) at.y() += font(Font::bold)->FontSize + kLegendGap * s;
  for (const LegendRow& row : rows) {
    draw_legend_row(area.list, to_imgui(at), row, {7 * s, kLegendText * s});
    at.y() += font(Font::small)->FontSize + kLegendGap * s;
  }
}

void draw_legend_strip(const Area& area, const LegendRows& rows) {
  if (rows.empty()) return;
  const auto& [list, rect] = area;
  const float s = overlay_scale(), size = font(Font::small)->FontSize;
  const float padding = 8 * s, line = size + 5 * s, sign_width = 18 * s, gap = 16 * s;
  constexpr double kMostHeight = 0.3;  // share of the view's height
  std::vector<Vector2d> places;        // relative to the strip's corner
  Vector2d at(padding, padding);
  for (const LegendRow& row : rows) {
    const double width = text_indent(row, sign_width) + text_width(Font::small, row.text);
    if (at.x() > padding && at.x() + width + padding > rect.size.x()) {
      if (at.y() + 2 * line > kMostHeight * rect.size.y()) break;
      at = {padding, at.y() + line};
    }
    places.push_back(at);
    at.x() += width + gap;
  }
  const double bottom = rect.min.y() + rect.size.y();
  const Vector2d corner(rect.min.x(), std::round(bottom - at.y() - size - padding));
  list.AddRectFilled(to_imgui(corner), area.high(), imgui_color(Role::background, kGround));
  for (std::size_t i = 0; i < places.size(); ++i)
    draw_legend_row(list, to_imgui(corner + places[i]), rows[i], {6 * s, sign_width});
}

LegendHits draw_legend_line(const Area& area,
                            double height,
                            const std::string& title,
                            const LegendRows& rows) {
  const auto& [list, rect] = area;
  const float s = overlay_scale(), size = font(Font::small)->FontSize;
  const double padding = 6 * s, line = size + 5 * s, sign_width = 16 * s, gap = 14 * s;
  LegendRows all = {{Sign::none, 0, title}};
  all.insert(all.end(), rows.begin(), rows.end());
  const double right = rect.size.x() - padding - text_width(Font::small, "\u2026 \u00d7");
  std::vector<Vector2d> places;
  Vector2d at(padding, padding);
  for (const LegendRow& row : all) {
    const double width = text_indent(row, sign_width) + text_width(Font::small, row.text);
    if (at.x() > padding && at.x() + width > right) {
      if (at.y() + 2 * line + padding > height) break;
      at = {padding, at.y() + line};
    }
    places.push_back(at);
    at.x() += width + gap;
  }
  const Vector2d end(rect.size.x(), at.y() + line + padding);
  list.AddRectFilled(area.low(), to_imgui(rect.min + end), imgui_color(Role::background, kGround));
  LegendHits hits;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const LegendRow& row = all[i];
    const Vector2d place = rect.min + places[i];
    const Role role = row.off ? Role::text_dim : Role::text;
    draw_legend_row(list,
                    to_imgui(place),
                    row,
                    {static_cast<float>(6 * s), static_cast<float>(sign_width)},
                    color_of(role));
    const double width = text_indent(row, sign_width) + text_width(Font::small, row.text);
    if (*row.toggle != 0) hits.push_back({{place, {width, line}}, row.toggle});
  }
  const std::string tail = places.size() < all.size() ? "\u2026 \u00d7" : "\u00d7";
  const Vector2d corner(rect.min.x() + rect.size.x() - padding - text_width(Font::small, tail),
                        rect.min.y() + padding);
  write_text(list, Font::small, corner, tail, color_of(Role::text_dim));
  hits.push_back({{corner, {text_width(Font::small, tail), line}}, "legend"});
  return hits;
}

void draw_badge(const Area& area,
                std::uint32_t rgb,
                const std::string& heading,
                const std::string& text) {
  const auto& [list, rect] = area;
  const float s = overlay_scale();
  const float padding = 11 * s;
  const double widest = std::max(0.86 * rect.size.x() - 2 * padding, 80.0 * s);
  // Dear ImGui would also break numbers at their point.
  const auto fits = [&](const auto& line) { return text_width(Font::regular, line) <= widest; };
  const std::string lines = fmt::format("{}", fmt::join(wrapped(text, fits), "\n"));
  const Vector2d title = text_size(Font::bold, heading);
  Vector2d body = Vector2d::Zero();
  if (!lines.empty()) body = text_size(Font::regular, lines) + Vector2d(0, 3 * s);
  const Vector2d size(std::max(title.x(), body.x()) + 2 * padding,
                      title.y() + body.y() + 2 * padding);
  const float below = 26 * s;  // height of the line with the pixel's value
  const Vector2d corner = rect.min + rect.size.cwiseProduct(Vector2d(0.5, 1));
  const Vector2d min = (corner - Vector2d(size.x() / 2, size.y() + below)).array().round();
  draw_ground({list, {min, size}}, rgb);
  const Vector2d at = min + Vector2d::Constant(padding);
  write_text(list, Font::bold, at, heading, rgb);
  write_text(list, Font::regular, at + Vector2d(0, title.y() + 3 * s), lines);
}

void write_text(
    ImDrawList& list, Font which, const Vector2d& at, const std::string& text, std::uint32_t rgb) {
  const ImFont* f = font(which);
  const ImVec2 place = to_imgui(at.array().round());
  list.AddText(f, f->FontSize, place, imgui_color(rgb), text.c_str());
}

void write_label(ImDrawList& list,
                 Font which,
                 const Vector2d& center,
                 const std::string& text,
                 std::uint32_t rgb) {
  const ImFont* f = font(which);
  const Vector2d corner = (center - text_size(which, text) / 2).array().round();
  const ImU32 rim = imgui_color(Role::background, 0.7);
  for (const double dx : {-1, 1})
    for (const double dy : {-1, 1})
      list.AddText(f, f->FontSize, to_imgui(corner + Vector2d(dx, dy)), rim, text.c_str());
  write_text(list, which, corner, text, rgb);
}

std::vector<std::string> wrapped(const std::string& text,
                                 const std::function<bool(const std::string& line)>& fits) {
  std::vector<std::string> lines;
  std::istringstream words(text);
  for (std::string word; words >> word;)
    if (!lines.empty() && fits(lines.back() + " " + word))
      lines.back() += " " + word;
    else
      lines.push_back(word);
  return lines;
}

Vector2d text_size(Font which, const std::string& text) {
  const ImFont* f = font(which);
  const ImVec2 size = f->CalcTextSizeA(f->FontSize, 1e6F, 0, text.c_str());
  return {size.x, size.y};
}

double text_width(Font which, const std::string& text) { return text_size(which, text).x(); }

std::string fitting_text(Font which, std::initializer_list<std::string> texts, double width) {
  for (const std::string& text : texts)
    if (text_width(which, text) <= width) return text;
  std::string text = *std::prev(texts.end());
  while (!text.empty() && text_width(which, text + "\u2026") > width) {
    while (text.size() > 1 && (text.back() & 0xC0) == 0x80) text.pop_back();  // UTF-8 continuation
    text.pop_back();
  }
  return text + "\u2026";
}

std::vector<std::pair<Vector2d, Vector2d>> dashes_along(std::span<const Vector2d> line,
                                                        std::span<const double> pattern) {
  std::vector<std::pair<Vector2d, Vector2d>> dashes;
  std::size_t phase = 0;
  double left = pattern.front();  // rest of the pattern's current length
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vector2d step = line[i] - line[i - 1];
    const double length = step.norm();
    for (double at = 0; at < length;) {
      const bool bends = at + left >= length;  // before the current length ends
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

std::vector<int> other_planes(const Window& window) {
  std::vector<int> others;
  for (int k = 0; k < static_cast<int>(window.planes.size()); ++k)
    if (k != window.leader) others.push_back(k);
  return others;
}

SignStyle track_style(const Inspection& inspection, int frame, int column) {
  if (is_excluded(inspection, column)) return {Sign::dot, color_of(Role::text_dim)};
  if (is_static(inspection, column)) return {Sign::square, color_of(Role::text_dim)};
  if (is_lost(*inspection.window, frame, column)) return {Sign::diamond, color_of(Role::lost)};
  const auto plane = plane_of_track(*inspection.window, frame, column);
  if (!plane) return {Sign::cross, color_of(Role::outlier)};
  const bool leading = *plane == inspection.window->leader;
  return {leading ? Sign::circle : Sign::thin_circle, plane_color(*plane)};
}

std::optional<Vector2d> place_of_sign(const Inspection& inspection, int frame, int column) {
  const Tracks& tracks = *inspection.tracks;
  if (frame < 0 || frame >= tracks.frame_count()) return std::nullopt;
  int last = frame;
  if (is_lost(*inspection.window, frame, column))
    while (last > 0 && !tracks.seen(last, column)) --last;
  return tracks.seen(last, column) ? std::optional<Vector2d>(tracks.raw_px[last].col(column))
                                   : std::nullopt;
}

SignStyle style_of(Readiness readiness) {
  if (readiness == Readiness::ready) return {Sign::disc, color_of(Role::good)};
  if (readiness == Readiness::weak) return {Sign::triangle, color_of(Role::warning)};
  return {Sign::cross, color_of(Role::bad)};
}

std::string verdict_text(const Verdict& verdict) {
  std::string text = to_string(verdict.readiness);
  if (verdict.normal_sigma_deg) text += ", normal " + sigma_text(*verdict.normal_sigma_deg);
  if (verdict.rotation_rms_px) {
    text += ", rotation alone leaves " + number_text(*verdict.rotation_rms_px, 2) + " px";
    if (verdict.noise_px) text += " where noise is " + number_text(*verdict.noise_px, 2) + " px";
  }
  if (verdict.largest_translation)
    text += ", moved " + number_text(*verdict.largest_translation, 3) + " d";
  return text;
}

std::vector<VerdictRun> verdict_runs(std::span<const Verdict> growth) {
  std::vector<VerdictRun> runs;
  for (int i = 0; i < static_cast<int>(growth.size()); ++i) {
    const Readiness readiness = growth[i].readiness;
    if (runs.empty() || runs.back().readiness != readiness)
      runs.push_back({i + 1, i + 1, readiness});
    runs.back().last = i + 1;
  }
  return runs;
}

std::uint32_t viridis(double share) {
  static const cv::Mat3b table = [] {
    cv::Mat1b levels(1, 256);
    std::iota(levels.begin(), levels.end(), std::uint8_t{0});
    cv::Mat3b colors;
    cv::applyColorMap(levels, colors, cv::COLORMAP_VIRIDIS);
    return colors;
  }();
  const cv::Vec3b bgr = table(static_cast<int>(std::lround(255 * std::clamp(share, 0.0, 1.0))));
  return std::uint32_t{bgr[2]} << 16 | std::uint32_t{bgr[1]} << 8 | bgr[0];
}

std::uint32_t TrackColors::rgb(int column) const {
  const auto& value = values[column];
  if (!value) return color_of(Role::text_dim);
  return ramp_color(high > low ? (*value - low) / (high - low) : 0.5);
}

std::shared_ptr<const TrackColors> track_colors(const Inspection& inspection, Coloring coloring) {
  if (coloring == Coloring::plane) return nullptr;
  const auto meters = coloring == Coloring::depth ? known_scale(inspection) : std::nullopt;
  TrackColors colors{.coloring = coloring, .in_meters = meters.has_value(), .values = {}};
  std::vector<double> known;
  for (const TrackLife& life : track_lives(inspection)) {
    std::optional<double> value = value_of(life, coloring);
    if (value) known.push_back(*value *= meters.value_or(1));
    colors.values.push_back(value);
  }
  std::ranges::sort(known);
  if (!known.empty())
    for (const auto& [end, share] : {std::pair{&colors.low, 0.05}, {&colors.high, 0.95}})
      *end = known[static_cast<std::size_t>(share * static_cast<double>(known.size() - 1))];
  return std::make_shared<const TrackColors>(std::move(colors));
}

LegendRows legend_rows(const TrackColors& colors) {
  const char* quantity = colors.coloring == Coloring::residual ? "residual"
                         : colors.coloring == Coloring::depth  ? "depth"
                                                               : "seen in";
  if (std::ranges::none_of(colors.values, [](const auto& value) { return value.has_value(); }))
    return {{Sign::disc, color_of(Role::text_dim), fmt::format("{} unknown", quantity)}};
  const std::string low = text_of(colors, colors.low);
  if (low == text_of(colors, colors.high))
    return {{Sign::disc, ramp_color(0.5), fmt::format("{} {}", quantity, low)}};
  return {{Sign::disc, ramp_color(0), fmt::format("{} {}", quantity, low)},
          {Sign::disc, ramp_color(1), text_of(colors, colors.high)}};
}

}  // namespace gpo
