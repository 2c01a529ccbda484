// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/timeline/timeline_bars.h"

#include "engine/inspection/plane_names.h"
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/views/overlay/plane_style.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

namespace gpo {
namespace {

struct BarColors {
  ImU32 inliers, others;
};

/// Of a frame of the window: its color is the verdict of the window that ends there. Red would be
/// taken for one, so what is no inlier is gray. A window that failed has no colors: green would be
/// taken for success.
BarColors bar_colors(const Inspection& inspection, std::span<const Verdict> growth, int frame) {
  const bool failed = !inspection.initialization || !inspection.initialization->ok;
  if (failed || growth.empty())
    return {imgui_color(Role::text_dim, 0.75), imgui_color(Role::text_dim, 0.4)};
  const bool judged = frame >= 1 && frame <= static_cast<int>(growth.size());
  const std::uint32_t rgb =
      judged ? style_of(growth[frame - 1].readiness).rgb : color_of(Role::text_dim);
  return {imgui_color(rgb, 0.75), imgui_color(Role::text_dim, 0.4)};
}

}  // namespace

void draw_tracks(
    ImDrawList& list, const Inspection& inspection, const TimeAxis& axis, float top, float bottom) {
  const Window& window = *inspection.window;
  const std::vector<Verdict> growth = shown_growth(inspection);
  const float a_track = (bottom - top) / static_cast<float>(std::max(1, window.track_count()));
  for (int i = 0; i < window.frame_count() && window.start + i < axis.frames; ++i) {
    const auto& points = window.points_px[i];
    const auto seen = (points.row(0).array() == points.row(0).array()).count();
    const BarColors colors = bar_colors(inspection, growth, i);
    const float left = slot_begin(axis, window.start + i);
    const float right = std::max(left + 1, slot_begin(axis, window.start + i + 1) - 1);
    float y = bottom;
    const auto stack = [&](std::ptrdiff_t tracks, ImU32 color) {
      const float upper = y - a_track * static_cast<float>(tracks);
      list.AddRectFilled({left, upper}, {right, y}, color);
      y = upper;
    };
    std::ptrdiff_t rest = seen - window.inlier_count(i);
    stack(window.inlier_count(i), colors.inliers);
    for (const int k : other_planes(window)) {
      const auto tracks = std::ranges::count(window.planes[k].inlier[i], true);
      stack(tracks, imgui_color(plane_color(window, k), 0.6));
      rest -= tracks;
    }
    stack(rest, colors.others);
  }
}

void draw_verdict_signs(
    ImDrawList& list, const Inspection& inspection, const TimeAxis& axis, float y, float scale) {
  for (const VerdictRun& run : verdict_runs(shown_growth(inspection))) {
    const int start = inspection.window->start;
    const float left = slot_begin(axis, start + run.first);
    const float width = slot_begin(axis, start + run.last + 1) - left;
    if (width < 16 * scale) continue;
    const ImVec2 at(left + 9 * scale, y);
    list.AddCircleFilled(at, 8 * scale, imgui_color(Role::background, 0.8), 20);
    const ReadinessStyle look = style_of(run.readiness);
    draw_sign(list, look.sign, at, look.rgb);
  }
}

namespace {

/// What a line over the bars shows.
struct MotionLine {
  const char* name;
  const char* unit;
  Role color;
  double FrameMotion::*value;
};
constexpr MotionLine kMotionLines[] = {
    {"parallax", " px", Role::text, &FrameMotion::parallax_px},
    {"rotation", "\u00b0/s", Role::rotation, &FrameMotion::rotation_rate_deg_s}};

double largest(const Inspection& inspection, const MotionLine& line) {
  double most = 0;
  for (const FrameMotion& motion : inspection.motion)
    if (std::isfinite(motion.*line.value)) most = std::max(most, motion.*line.value);
  return most;
}

}  // namespace

void draw_motion(
    ImDrawList& list, const Inspection& inspection, const TimeAxis& axis, float top, float bottom) {
  const int start = inspection.window->start;
  for (const MotionLine& line : kMotionLines) {
    const double most = largest(inspection, line);
    if (most <= 0) continue;
    std::vector<ImVec2> points;
    for (int i = 0; i < static_cast<int>(inspection.motion.size()); ++i) {
      const double value = inspection.motion[i].*line.value;
      if (std::isfinite(value))
        points.emplace_back(slot_middle(axis, start + i),
                            bottom - static_cast<float>(value / most) * (bottom - top));
    }
    const auto count = static_cast<int>(points.size());
    list.AddPolyline(points.data(), count, imgui_color(Role::background, 0.7), 0, 3);
    list.AddPolyline(points.data(), count, imgui_color(line.color), 0, 1.4F);
  }
}

void draw_scale_mark(ImDrawList& list,
                     const Inspection& inspection,
                     const TimeAxis& axis,
                     float top,
                     float bottom,
                     float scale) {
  if (!inspection.metric_scale_from) return;
  const int frame = inspection.window->start + *inspection.metric_scale_from;
  const float x = std::round(slot_begin(axis, frame + 1));
  const ImU32 color = imgui_color(Role::gravity);
  const float dash = std::round(3 * scale), width = std::max(1.0F, std::round(1.5F * scale));
  for (float y = top; y < bottom; y += 2 * dash)
    list.AddRectFilled({x, y}, {x + width, std::min(bottom, y + dash)}, color);
  const ImFont* f = font(Font::small);
  list.AddText(f, f->FontSize, {x + 3 * scale, std::round(top)}, color, "m");
}

void draw_bookmarks(ImDrawList& list,
                    std::span<const Bookmark> bookmarks,
                    const TimeAxis& axis,
                    float top,
                    float scale) {
  for (const Bookmark& bookmark : bookmarks) {
    const float x = std::round(slot_middle(axis, bookmark.frame));
    const ImU32 color = imgui_color(Role::warning);
    list.AddLine({x, top - 6 * scale}, {x, top + 10 * scale}, color, std::round(1.5F * scale));
    list.AddRectFilled({x, top - 6 * scale}, {x + 8 * scale, top}, color);
  }
}

namespace {

void draw_failure(ImDrawList& list, const std::string& reason, float left, float top, float scale) {
  const ImFont* f = font(Font::small);
  draw_sign(list, Sign::cross, {left + 6 * scale, top + f->FontSize / 2}, color_of(Role::bad));
  write_text(list, Font::small, {left + 16 * scale, top}, "not initialized: " + reason);
}

}  // namespace

void draw_verdict_legend(
    ImDrawList& list, const Inspection& inspection, float left, float top, float scale) {
  if (inspection.initialization && !inspection.initialization->ok)
    return draw_failure(list, inspection.initialization->reason, left, top, scale);
  const ImFont* f = font(Font::small);
  const auto write = [&](const char* text, std::uint32_t rgb) {
    write_text(list, Font::small, {left, top}, text, rgb);
    left += static_cast<float>(text_width(Font::small, text));
  };
  write("window up to here:", color_of(Role::text_dim));
  for (const Readiness readiness : {Readiness::ready, Readiness::weak, Readiness::degenerate}) {
    const ReadinessStyle look = style_of(readiness);
    draw_sign(list, look.sign, {left + 14 * scale, top + f->FontSize / 2}, look.rgb);
    left += 23 * scale;
    write(to_string(readiness), color_of(Role::text));
  }
  left += 16 * scale;
  write("height: tracks", color_of(Role::text_dim));
  for (const int k : other_planes(*inspection.window)) {
    draw_sign(list,
              Sign::disc,
              {left + 12 * scale, top + f->FontSize / 2},
              plane_color(*inspection.window, k));
    left += 20 * scale;
    write(plane_title(inspection, k).c_str(), color_of(Role::text_dim));
  }
  left += 8 * scale;
  write("gray: outliers", color_of(Role::text_dim));
  if (inspection.metric_scale_from) {
    left += 16 * scale;
    write("m:", color_of(Role::gravity));
    write(" meters known from here", color_of(Role::text_dim));
  }
  for (const MotionLine& line : kMotionLines) {
    if (inspection.motion.empty()) return;
    left += 16 * scale;
    const float y = std::round(top + f->FontSize / 2);
    list.AddLine({left, y}, {left + 14 * scale, y}, imgui_color(line.color), 1.4F * scale);
    left += 18 * scale;
    write(fmt::format("{} to {:.0f}{}", line.name, largest(inspection, line), line.unit).c_str(),
          color_of(Role::text_dim));
  }
}

}  // namespace gpo
