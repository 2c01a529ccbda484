// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/image/image_drawing.h"

#include "ui/context/theme.h"
#include "ui/context/window_image.h"
#include "ui/views/overlay/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <utility>

#include <Eigen/Geometry>
#include <imgui.h>

namespace gpo {

namespace {

using Eigen::Vector2d;

/// Only what the picture leaves free: without a graphics card each layer costs milliseconds.
void draw_surroundings(ImDrawList& list,
                       const ScreenRect& rect,
                       const ImVec2& image_low,
                       const ImVec2& image_high) {
  const ImU32 color = imgui_color(Role::background);
  const ImVec2 low = to_imgui(rect.min), high = to_imgui(rect.min + rect.size);
  // The picture's last pixels are whole ones only where its scale is.
  const float right = std::clamp(std::floor(image_high.x), low.x, high.x);
  const float bottom = std::clamp(std::floor(image_high.y), low.y, high.y);
  const float left = std::clamp(image_low.x, low.x, right);
  const float top = std::clamp(image_low.y, low.y, bottom);
  const std::array<std::pair<ImVec2, ImVec2>, 4> sides = {{{low, {high.x, top}},
                                                           {{low.x, bottom}, high},
                                                           {{low.x, top}, {left, bottom}},
                                                           {{right, top}, {high.x, bottom}}}};
  for (const auto& [from, to] : sides)
    if (to.x > from.x && to.y > from.y) list.AddRectFilled(from, to, color);
}

constexpr int kCells = 64;  ///< a side, so small that the lens is straight within each

/// The picture cell by cell.
void draw_undistorted(ImDrawList& list,
                      const Camera& camera,
                      void* texture,
                      const ImageMapping& mapping) {
  const auto share = [](int i, int j) -> Vector2d { return Vector2d(i, j) / kCells; };
  std::array<std::array<Vector2d, kCells + 1>, kCells + 1> corners;
  for (int i = 0; i <= kCells; ++i)
    for (int j = 0; j <= kCells; ++j)
      corners[i][j] = to_screen(mapping,
                                share(i, j).cwiseProduct(Vector2d(camera.width, camera.height)) -
                                    Vector2d::Constant(0.5));
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      const Vector2d &a = corners[i][j], &b = corners[i + 1][j];
      const Vector2d &c = corners[i + 1][j + 1], &d = corners[i][j + 1];
      if (!(a + b + c + d).allFinite()) continue;
      list.AddImageQuad(texture,
                        to_imgui(a),
                        to_imgui(b),
                        to_imgui(c),
                        to_imgui(d),
                        to_imgui(share(i, j)),
                        to_imgui(share(i + 1, j)),
                        to_imgui(share(i + 1, j + 1)),
                        to_imgui(share(i, j + 1)));
    }
}

}  // namespace

void draw_image(ImDrawList& list,
                  const ScreenRect& rect,
                  const Camera& camera,
                  ImageTexture* image,
                  const ImageMapping& mapping) {
  const ImVec2 low = to_imgui(mapping.origin);
  const ImVec2 high =
      to_imgui(mapping.origin + mapping.scale * Vector2d(camera.width, camera.height));
  draw_surroundings(list, rect, low, high);
  if (image == nullptr || image->id() == nullptr)
    return list.AddRectFilled(low, high, imgui_color(Role::raised));
  image->set_screen_scale(mapping.scale);
  mark_content(list, image->revision());
  if (mapping.undistorted == nullptr) return list.AddImage(image->id(), low, high);
  list.AddRectFilled(low, high, imgui_color(Role::background));
  draw_undistorted(list, camera, image->id(), mapping);
}

void draw_part(ImDrawList& list,
               const Camera& camera,
               const ImageTexture& image,
               const ImageMapping& mapping,
               const std::array<Vector2d, 3>& triangle_raw_px) {
  constexpr int kPieces = 4;  // a side: small enough that the lens is straight within
  const Vector2d& corner = triangle_raw_px[0];
  const Vector2d u = (triangle_raw_px[1] - corner) / kPieces;
  const Vector2d v = (triangle_raw_px[2] - corner) / kPieces;
  const auto draw = [&](const std::array<Vector2d, 3>& piece) {
    std::array<ImVec2, 3> screen, share;
    for (int k = 0; k < 3; ++k) {
      screen[k] = to_imgui(to_screen(mapping, piece[k]));
      share[k] = to_imgui((piece[k] + Vector2d::Constant(0.5))
                              .cwiseQuotient(Vector2d(camera.width, camera.height)));
    }
    list.AddImageQuad(image.id(),
                      screen[0],
                      screen[1],
                      screen[2],
                      screen[2],
                      share[0],
                      share[1],
                      share[2],
                      share[2]);
  };
  for (int i = 0; i < kPieces; ++i)
    for (int j = 0; i + j < kPieces; ++j) {
      const Vector2d at = corner + i * u + j * v;
      draw({at, at + u, at + v});
      if (i + j + 1 < kPieces) draw({at + u, at + u + v, at + v});
    }
}

namespace {

using Eigen::Vector2d;
using Outline = std::vector<Vector2d>;

std::vector<ImVec2> on_screen(const ImageMapping& mapping, const Outline& raw_px) {
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

void draw_lit_face(ImDrawList& list, const ImageMapping& mapping, const CubeFace& face) {
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
                 const ImageMapping& mapping,
                 const std::vector<Outline>& rings) {
  constexpr double kDarkness = 0.046;  // of a ring; they lie one on the other
  for (const Outline& ring : rings)
    fill(list, on_screen(mapping, ring), imgui_color(std::uint32_t{0}, kDarkness));
}

void draw_solid_edge(ImDrawList& list, const ImageMapping& mapping, const CubeEdge& edge) {
  const auto points = on_screen(mapping, edge.raw_px);
  polyline(list, points, imgui_color(Role::background, 0.4), edge.base ? 4.4F : 3.6F);
  polyline(list, points, imgui_color(Role::cube_base), edge.base ? 2.8F : 1.8F);
}

}  // namespace

void draw_wireframe(ImDrawList& list, const ImageMapping& mapping, const CubeImage& cube) {
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
               const ImageMapping& mapping,
               const CubeImage& cube,
               const std::vector<Outline>& shadow) {
  draw_shadow(list, mapping, shadow);
  for (const CubeFace& face : cube.faces)
    if (face.facing && !face.base && !face.raw_px.empty()) draw_lit_face(list, mapping, face);
  for (const CubeEdge& edge : cube.edges)
    if (!edge.hidden) draw_solid_edge(list, mapping, edge);
}

void draw_foot(ImDrawList& list,
               const ImageMapping& mapping,
               const CubeImage& cube,
               const std::vector<Outline>& shadow) {
  draw_shadow(list, mapping, shadow);
  for (const CubeEdge& edge : cube.edges)
    if (edge.base) draw_solid_edge(list, mapping, edge);
}

std::pair<ImVec2, ImVec2> bounds(const ImageMapping& mapping, const CubeImage& cube) {
  Eigen::AlignedBox2d box;
  for (const CubeEdge& edge : cube.edges)
    for (const Vector2d& pixel : edge.raw_px) box.extend(to_screen(mapping, pixel));
  return {to_imgui(box.min()), to_imgui(box.max())};
}

void draw_true_cube(ImDrawList& list, const ImageMapping& mapping, const CubeImage& cube) {
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

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Of the triangles in front of the camera, the farthest first.
std::vector<std::size_t> far_to_near(const SolidModel& model,
                                     const std::vector<Vector3d>& points_c,
                                     const std::vector<Vector2d>& screen) {
  std::vector<std::pair<double, std::size_t>> depths;
  for (std::size_t i = 0; i < model.triangles.size(); ++i) {
    const auto seen = [&](int corner) { return screen[corner].allFinite(); };
    if (!std::ranges::all_of(model.triangles[i], seen)) continue;
    double depth = 0;
    for (const int corner : model.triangles[i]) depth += points_c[corner].norm();
    depths.emplace_back(-depth, i);
  }
  std::ranges::sort(depths);
  std::vector<std::size_t> order;
  order.reserve(depths.size());
  for (const auto& [depth, triangle] : depths) order.push_back(triangle);
  return order;
}

void fill_triangles(ImDrawList& list,
                    const SolidModel& model,
                    const std::vector<Vector2d>& screen,
                    std::span<const std::size_t> triangles) {
  const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
  const std::uint32_t cube_rgb = color_of(Role::cube_face);
  const auto count = static_cast<int>(triangles.size());
  list.PrimReserve(3 * count, 3 * count);
  for (const std::size_t triangle : triangles) {
    for (const int corner : model.triangles[triangle]) {
      const double light = light_above_ground(model.points[corner].z());
      const ImU32 color = imgui_color(lit_rgb(model, triangle, cube_rgb, light));
      list.PrimVtx(to_imgui(screen[corner]), white, color);
    }
  }
}

}  // namespace

void draw_model(ImDrawList& list,
                const ImageMapping& mapping,
                const Camera& camera,
                const Pose& pose,
                const SolidModel& model,
                const std::vector<Vector3d>& points_w) {
  constexpr std::size_t kAtOnce = 10'000;  // their corners' indices fit into 16 bits
  std::vector<Vector3d> points_c;
  std::vector<Vector2d> screen;
  points_c.reserve(points_w.size());
  screen.reserve(points_w.size());
  for (const Vector3d& point : points_w) {
    points_c.push_back(to_camera(pose, point));
    const bool in_front = points_c.back().z() > 0;
    screen.push_back(in_front ? to_screen(mapping, project(camera, points_c.back()))
                              : Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
  }
  const auto order = far_to_near(model, points_c, screen);
  for (std::size_t first = 0; first < order.size(); first += kAtOnce)
    fill_triangles(list,
                   model,
                   screen,
                   std::span(order).subspan(first, std::min(kAtOnce, order.size() - first)));
}

}  // namespace gpo
