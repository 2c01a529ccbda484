// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/image/mask_drawing.h"

#include "engine/inspection/settings/settings_table.h"
#include "engine/inspection/studies/studies.h"

#include <algorithm>
#include <array>

namespace gpo {
namespace {

/// Returns a closed outline on the screen, bent if the image is shown undistorted.
Outline outline_on_screen(const ImageCanvas& canvas, const std::vector<Vector2d>& corners_raw_px) {
  constexpr int kPieces = 16;  // per edge
  Outline outline;
  for (std::size_t k = 0; k < corners_raw_px.size(); ++k) {
    const Vector2d& from = corners_raw_px[k];
    const Vector2d& to = corners_raw_px[(k + 1) % corners_raw_px.size()];
    for (int i = 0; i < kPieces; ++i)
      outline.push_back(to_screen(canvas.mapping, from + i * (to - from) / kPieces));
  }
  if (!outline.empty()) outline.push_back(outline.front());
  return outline;
}

/// Fills a closed outline with lines that rise to the right.
void hatch(const ImageCanvas& canvas, const Outline& outline, ImU32 color) {
  const double step = 9 * overlay_scale();
  const auto [least, most] =
      std::ranges::minmax(outline, {}, [](const Vector2d& at) { return at.sum(); });
  for (double sum = step * std::ceil(least.sum() / step); sum < most.sum(); sum += step) {
    std::vector<Vector2d> crossings;
    for (std::size_t k = 0; k + 1 < outline.size(); ++k) {
      const double a = outline[k].sum() - sum, b = outline[k + 1].sum() - sum;
      if ((a > 0) != (b > 0))
        crossings.emplace_back(outline[k] + a / (a - b) * (outline[k + 1] - outline[k]));
    }
    std::ranges::sort(crossings, {}, [](const Vector2d& at) { return at.x(); });
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2)
      canvas.list.AddLine(
          to_imgui(crossings[k]), to_imgui(crossings[k + 1]), color, overlay_scale());
  }
}

}  // namespace

std::uint32_t mask_color(MaskKind kind) {
  return kind == MaskKind::plane ? plane_color(0) : color_of(Role::warning);
}

void draw_mask(const ImageCanvas& canvas, const Mask& mask) {
  const float s = overlay_scale();
  const Outline outline = outline_on_screen(canvas, mask.outline());
  if (outline.empty()) return;
  const std::uint32_t rgb = mask_color(mask.kind);
  if (mask.kind == MaskKind::leave_out) hatch(canvas, outline, imgui_color(rgb, 0.45));
  const std::array pattern = {10.0 * s, 4.0 * s, 2.0 * s, 4.0 * s};
  for (const auto& [start, end] : dashes_along(outline, pattern)) {
    const ImVec2 from = to_imgui(start), to = to_imgui(end);
    canvas.list.AddLine(from, to, imgui_color(Role::background, 0.6), 4 * s);
    canvas.list.AddLine(from, to, imgui_color(rgb), 2 * s);
  }
}

void draw_masks(const ImageCanvas& canvas, const Masks& masks) {
  for (const Mask& mask : masks.areas) draw_mask(canvas, mask);
}

void add_mask_rows(const Masks& masks, LegendRows& rows) {
  if (masks.has(MaskKind::leave_out))
    rows.push_back({Sign::square, mask_color(MaskKind::leave_out), "mask: tracks left out"});
  if (masks.has(MaskKind::plane))
    rows.push_back({Sign::square, mask_color(MaskKind::plane), "mask: plane 1 only here"});
}

}  // namespace gpo
