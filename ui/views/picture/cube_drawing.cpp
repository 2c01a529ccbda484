// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/picture/cube_drawing.h"

#include "ui/context/theme.h"
#include "ui/views/overlay/dash_pattern.h"
#include "ui/views/overlay/overlay.h"

#include <algorithm>
#include <functional>

#include <Eigen/Geometry>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Outline = std::vector<Vector2d>;

std::vector<ImVec2> on_screen(const PictureMapping& mapping, const Outline& raw_px) {
  std::vector<ImVec2> points;
  points.reserve(raw_px.size());
  for (const Vector2d& pixel : raw_px) points.push_back(to_imgui(to_screen(mapping, pixel)));
  return points;
}

void polyline(ImDrawList& list, const std::vector<ImVec2>& points, ImU32 color, float width) {
  list.AddPolyline(
      points.data(), static_cast<int>(points.size()), color, 0, width * overlay_scale());
}

/// A fan around the middle: right for outlines that the lens bends inwards, too. Colors by point.
void fill(ImDrawList& list,
          const std::vector<ImVec2>& outline,
          ImU32 middle_color,
          const std::function<ImU32(std::size_t)>& color) {
  if (outline.empty()) return;
  ImVec2 middle(0, 0);
  const auto count = static_cast<int>(outline.size());
  for (const ImVec2& point : outline) {
    middle.x += point.x / static_cast<float>(count);
    middle.y += point.y / static_cast<float>(count);
  }
  const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
  list.PrimReserve(3 * count, count + 1);
  const auto first = static_cast<ImDrawIdx>(list._VtxCurrentIdx);
  list.PrimWriteVtx(middle, white, middle_color);
  for (std::size_t i = 0; i < outline.size(); ++i) list.PrimWriteVtx(outline[i], white, color(i));
  for (int i = 0; i < count; ++i) {
    list.PrimWriteIdx(first);
    list.PrimWriteIdx(static_cast<ImDrawIdx>(first + 1 + i));
    list.PrimWriteIdx(static_cast<ImDrawIdx>(first + 1 + (i + 1) % count));
  }
}

void fill(ImDrawList& list, const std::vector<ImVec2>& outline, ImU32 color) {
  fill(list, outline, color, [color](std::size_t) { return color; });
}

/// Of a face in soft light from above and the side: the top is brightest.
double brightness(const CubeFace& face) {
  const auto all = [&](int bit, int value) {
    return std::ranges::all_of(face.corners,
                               [&](int corner) { return ((corner >> bit) & 1) == value; });
  };
  if (all(2, 1)) return 1;
  return all(0, 0) || all(0, 1) ? 0.78 : 0.62;
}

/// How high a point of the outline is, 0 to 1.
double height_at(const CubeFace& face, std::size_t point) {
  const std::size_t a_side = face.raw_px.size() / 4;
  const std::size_t side = point / a_side;
  const double along = static_cast<double>(point % a_side) / static_cast<double>(a_side);
  const double from = face.corners[side] >> 2, to = face.corners[(side + 1) % 4] >> 2;
  return from + along * (to - from);
}

void draw_lit_face(ImDrawList& list, const PictureMapping& mapping, const CubeFace& face) {
  constexpr double kAtFoot = 0.55;  // of the light: the ground keeps the rest off
  constexpr double kOpacity = 0.94;
  const double light = brightness(face);
  const auto lit = [&](double height) {
    const double occluded = kAtFoot + (1 - kAtFoot) * (1 - (1 - height) * (1 - height));
    return imgui_color(mixed_rgb(0, color_of(Role::cube_face), light * occluded), kOpacity);
  };
  const bool top = light == 1;
  fill(list, on_screen(mapping, face.raw_px), lit(top ? 1 : 0.5), [&](std::size_t i) {
    return lit(height_at(face, i));
  });
}

void draw_shadow(ImDrawList& list,
                 const PictureMapping& mapping,
                 const std::vector<Outline>& rings) {
  constexpr double kDarkness = 0.046;  // of a ring; they lie one on the other
  for (const Outline& ring : rings)
    fill(list, on_screen(mapping, ring), imgui_color(std::uint32_t{0}, kDarkness));
}

void draw_solid_edge(ImDrawList& list, const PictureMapping& mapping, const CubeEdge& edge) {
  const auto points = on_screen(mapping, edge.raw_px);
  polyline(list, points, imgui_color(Role::background, 0.4), edge.base ? 4.4F : 3.6F);
  polyline(list, points, imgui_color(Role::cube_base), edge.base ? 2.8F : 1.8F);
}

}  // namespace

void draw_wireframe(ImDrawList& list, const PictureMapping& mapping, const CubePicture& cube) {
  const auto draw_edges = [&](bool hidden) {
    for (const CubeEdge& edge : cube.edges) {
      if (edge.hidden != hidden) continue;
      const std::uint32_t rgb = edge.base ? color_of(Role::cube_base) : color_of(Role::cube_edge);
      const auto points = on_screen(mapping, edge.raw_px);
      const float width = (edge.base ? 3.0F : 2.2F) * (hidden ? 0.6F : 1.0F);
      if (!hidden) polyline(list, points, imgui_color(Role::background, 0.5), width + 2.2F);
      polyline(list, points, imgui_color(rgb, hidden ? 0.55 : 1), width);
    }
  };
  draw_edges(true);
  draw_edges(false);
}

void draw_body(ImDrawList& list,
               const PictureMapping& mapping,
               const CubePicture& cube,
               const std::vector<Outline>& shadow) {
  draw_shadow(list, mapping, shadow);
  for (const CubeFace& face : cube.faces)
    if (face.facing && !face.base && !face.raw_px.empty()) draw_lit_face(list, mapping, face);
  for (const CubeEdge& edge : cube.edges)
    if (!edge.hidden) draw_solid_edge(list, mapping, edge);
}

void draw_foot(ImDrawList& list,
               const PictureMapping& mapping,
               const CubePicture& cube,
               const std::vector<Outline>& shadow) {
  draw_shadow(list, mapping, shadow);
  for (const CubeEdge& edge : cube.edges)
    if (edge.base) draw_solid_edge(list, mapping, edge);
}

std::pair<ImVec2, ImVec2> bounds(const PictureMapping& mapping, const CubePicture& cube) {
  Eigen::AlignedBox2d box;
  for (const CubeEdge& edge : cube.edges)
    for (const Vector2d& pixel : edge.raw_px) box.extend(to_screen(mapping, pixel));
  return {to_imgui(box.min()), to_imgui(box.max())};
}

void draw_true_cube(ImDrawList& list, const PictureMapping& mapping, const CubePicture& cube) {
  const double s = overlay_scale();
  const std::array pattern = {7 * s, 4.5 * s};
  for (const CubeEdge& edge : cube.edges) {
    Outline line;
    for (const Vector2d& pixel : edge.raw_px) line.push_back(to_screen(mapping, pixel));
    for (const auto& [from, to] : dashes_along(line, pattern)) {
      if (!edge.hidden)
        list.AddLine(to_imgui(from),
                     to_imgui(to),
                     imgui_color(Role::background, 0.5),
                     3.4F * overlay_scale());
      list.AddLine(to_imgui(from),
                   to_imgui(to),
                   imgui_color(Role::truth, edge.hidden ? 0.45 : 1),
                   1.7F * overlay_scale());
    }
  }
}

}  // namespace gpo
