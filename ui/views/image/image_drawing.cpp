// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/studies.h"
#include "ui/views/image/image_geometry.h"

#include <algorithm>
#include <limits>

namespace gpo {
namespace {

Vector2d size_of(const Camera& camera) { return {camera.width, camera.height}; }

/// Fills only the area around the image: without a graphics card each layer costs milliseconds.
void draw_surroundings(const Area& area, const ImVec2& image_low, const ImVec2& image_high) {
  const ImVec2 low = area.low(), high = area.high();
  // The image's last row and column cover their pixels only in part at most scales.
  const float right = std::clamp(std::floor(image_high.x), low.x, high.x);
  const float bottom = std::clamp(std::floor(image_high.y), low.y, high.y);
  const float left = std::clamp(image_low.x, low.x, right);
  const float top = std::clamp(image_low.y, low.y, bottom);
  const std::array<std::pair<ImVec2, ImVec2>, 4> sides = {{{low, {high.x, top}},
                                                           {{low.x, bottom}, high},
                                                           {{low.x, top}, {left, bottom}},
                                                           {{right, top}, {high.x, bottom}}}};
  for (const auto& [from, to] : sides)
    if (to.x > from.x && to.y > from.y)
      area.list.AddRectFilled(from, to, imgui_color(Role::background));
}

struct TexturePoint {
  ImVec2 screen, share;
};

TexturePoint texture_point(const ImageCanvas& canvas, const Vector2d& raw_px) {
  const Vector2d from_corner = raw_px + Vector2d::Constant(0.5);
  return {canvas.at(raw_px), to_imgui(from_corner.cwiseQuotient(size_of(canvas.camera)))};
}

/// Draws a part of the texture; its edges are straight on the screen.
void draw_quad(ImDrawList& list, void* texture, const std::array<TexturePoint, 4>& points) {
  for (const TexturePoint& point : points)
    if (!std::isfinite(point.screen.x + point.screen.y)) return;
  const auto& [a, b, c, d] = points;
  list.AddImageQuad(
      texture, a.screen, b.screen, c.screen, d.screen, a.share, b.share, c.share, d.share);
}

/// Draws the image in `cells` x `cells` parts.
void draw_cells(const ImageCanvas& canvas, void* texture, int cells) {
  const auto corner = [&](int i, int j) {
    const Vector2d from_corner = Vector2d(i, j).cwiseProduct(size_of(canvas.camera)) / cells;
    return texture_point(canvas, from_corner - Vector2d::Constant(0.5));
  };
  std::vector<TexturePoint> left(cells + 1), right(cells + 1);
  for (int j = 0; j <= cells; ++j) right[j] = corner(0, j);
  for (int i = 1; i <= cells; ++i) {
    left.swap(right);
    for (int j = 0; j <= cells; ++j) right[j] = corner(i, j);
    for (int j = 0; j < cells; ++j)
      draw_quad(canvas.list, texture, {left[j], right[j], right[j + 1], left[j + 1]});
  }
}

std::vector<ImVec2> points_on_screen(const ImageCanvas& canvas, const Outline& raw_px) {
  std::vector<ImVec2> points;
  for (const Vector2d& pixel : raw_px) points.push_back(canvas.at(pixel));
  return points;
}

/// Fills a fan around the middle, also of outlines that the lens bends. `color(point's index)`.
void fill(const ImageCanvas& canvas,
          const Outline& raw_px,
          ImU32 middle_color,
          const std::function<ImU32(std::size_t)>& color) {
  if (raw_px.empty()) return;
  const std::vector<ImVec2> outline = points_on_screen(canvas, raw_px);
  ImVec2 middle(0, 0);
  const auto count = static_cast<int>(outline.size());
  for (const ImVec2& point : outline) {
    middle.x += point.x / static_cast<float>(count);
    middle.y += point.y / static_cast<float>(count);
  }
  ImDrawList& list = canvas.list;
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

/// Brightness of a face in soft light from above and the side: the top is brightest.
double brightness(const CubeFace& face) {
  const auto all = [&](int bit, int value) {
    return std::ranges::all_of(face.corners,
                               [&](int corner) { return ((corner >> bit) & 1) == value; });
  };
  if (all(2, 1)) return 1;
  return all(0, 0) || all(0, 1) ? 0.78 : 0.62;
}

void draw_lit_face(const ImageCanvas& canvas, const CubeFace& face, std::uint32_t rgb) {
  constexpr double kAtFoot = 0.55;  // share of the light that the ground leaves
  constexpr double kOpacity = 0.94;
  const double light = brightness(face);
  const auto lit = [&](double height) {
    const double share = light_above_ground(height, kAtFoot);
    return imgui_color(mixed_rgb(0, rgb, light * share), kOpacity);
  };
  fill(canvas, face.raw_px, lit(light == 1 ? 1 : 0.5), [&](std::size_t i) {
    return lit(face.heights[i]);
  });
}

using DepthAndTriangle = std::pair<double, std::size_t>;

void fill_triangles(ImDrawList& list,
                    const SolidModel& model,
                    const std::vector<Vector2d>& screen,
                    std::span<const DepthAndTriangle> triangles) {
  const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
  const std::uint32_t cube_rgb = color_of(Role::cube_face);
  const auto count = static_cast<int>(triangles.size());
  list.PrimReserve(3 * count, 3 * count);
  for (const auto& [depth, triangle] : triangles)
    for (const int corner : model.triangles[triangle]) {
      const double light = light_above_ground(model.points[corner].z());
      const ImU32 color = imgui_color(lit_rgb(model, triangle, cube_rgb, light));
      list.PrimVtx(to_imgui(screen[corner]), white, color);
    }
}

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

void ImageCanvas::polyline(const Outline& raw_px, ImU32 color, float width) const {
  const std::vector<ImVec2> points = points_on_screen(*this, raw_px);
  list.AddPolyline(
      points.data(), static_cast<int>(points.size()), color, 0, width * overlay_scale());
}

void draw_image(const ImageCanvas& canvas, ImageTexture* image) {
  ImDrawList& list = canvas.list;
  const ImageMapping& mapping = canvas.mapping;
  const ImVec2 low = to_imgui(mapping.origin);
  const ImVec2 high = to_imgui(mapping.end());
  draw_surroundings(canvas, low, high);
  if (image == nullptr || image->id() == nullptr)
    return list.AddRectFilled(low, high, imgui_color(Role::raised));
  image->set_screen_scale(mapping.scale);
  mark_content(list, image->revision());
  if (mapping.undistorted == nullptr) return draw_cells(canvas, image->id(), 1);
  list.AddRectFilled(low, high, imgui_color(Role::background));
  constexpr int kCells = 64;  // small enough that the lens is linear within
  draw_cells(canvas, image->id(), kCells);
}

void draw_part(const ImageCanvas& canvas, const ImageTexture& image, const Triangle& triangle) {
  constexpr int kPieces = 4;  // per side: small enough that the lens is linear within
  const Vector2d u = (triangle[1] - triangle[0]) / kPieces;
  const Vector2d v = (triangle[2] - triangle[0]) / kPieces;
  for (int i = 0; i < kPieces; ++i)
    for (int j = 0; i + j < kPieces; ++j) {
      const Vector2d at = triangle[0] + i * u + j * v;
      const auto a = texture_point(canvas, at), b = texture_point(canvas, at + u);
      const auto c = texture_point(canvas, at + v), d = texture_point(canvas, at + u + v);
      draw_quad(canvas.list, image.id(), {a, b, c, c});
      if (i + j + 1 < kPieces) draw_quad(canvas.list, image.id(), {b, d, c, c});
    }
}

std::uint32_t cube_color(const CubeAnchor& anchor, const Window& window) {
  const int plane = anchor.plane.value_or(window.leader);
  return plane == 0 ? color_of(Role::cube_base) : plane_color(plane);
}

std::uint32_t cube_face_color(const CubeAnchor& anchor, const Window& window) {
  constexpr double kLight = 0.5;  // share of white
  const int plane = anchor.plane.value_or(window.leader);
  if (plane == 0) return color_of(Role::cube_face);
  return mixed_rgb(plane_color(plane), 0xFFFFFF, kLight);
}

void draw_wireframe(const ImageCanvas& canvas, const CubeImage& cube, std::uint32_t rgb) {
  for (const bool hidden : {true, false})
    for (const CubeEdge& edge : cube.edges) {
      if (edge.hidden != hidden) continue;
      const std::uint32_t edge_rgb = edge.base ? rgb : color_of(Role::cube_edge);
      const float width = (edge.base ? 3.0F : 2.2F) * (hidden ? 0.6F : 1.0F);
      if (!hidden) canvas.polyline(edge.raw_px, imgui_color(Role::background, 0.5), width + 2.2F);
      canvas.polyline(edge.raw_px, imgui_color(edge_rgb, hidden ? 0.55 : 1), width);
    }
}

void draw_body(const ImageCanvas& canvas, const CubeBody& body, bool model) {
  const auto& [cube, rings, edge_rgb, face_rgb] = body;
  constexpr double kDarkness = 0.046;  // per ring of the shadow; rings overlap
  const ImU32 dark = imgui_color(std::uint32_t{0}, kDarkness);
  for (const Outline& ring : rings) fill(canvas, ring, dark, [&](std::size_t) { return dark; });
  for (const CubeFace& face : cube.faces)
    if (!model && face.facing && !face.base && !face.raw_px.empty())
      draw_lit_face(canvas, face, face_rgb);
  for (const CubeEdge& edge : cube.edges) {
    if (model ? !edge.base : edge.hidden) continue;
    canvas.polyline(edge.raw_px, imgui_color(Role::background, 0.4), edge.base ? 4.4F : 3.6F);
    canvas.polyline(edge.raw_px, imgui_color(edge_rgb), edge.base ? 2.8F : 1.8F);
  }
}

Eigen::AlignedBox2d bounds(const ImageCanvas& canvas, const CubeImage& cube) {
  Eigen::AlignedBox2d box;
  for (const CubeEdge& edge : cube.edges)
    for (const Vector2d& pixel : edge.raw_px) box.extend(to_screen(canvas.mapping, pixel));
  return box;
}

void draw_dashed_cube(const ImageCanvas& canvas, const CubeImage& cube, std::uint32_t rgb) {
  const float s = overlay_scale();
  const std::array pattern = {7.0 * s, 4.5 * s};
  for (const CubeEdge& edge : cube.edges) {
    Outline line;
    for (const Vector2d& pixel : edge.raw_px) line.push_back(to_screen(canvas.mapping, pixel));
    for (const auto& [start, end] : dashes_along(line, pattern)) {
      const ImVec2 from = to_imgui(start), to = to_imgui(end);
      if (!edge.hidden) canvas.list.AddLine(from, to, imgui_color(Role::background, 0.5), 3.4F * s);
      canvas.list.AddLine(from, to, imgui_color(rgb, edge.hidden ? 0.45 : 1), 1.7F * s);
    }
  }
}

void draw_model(const ImageCanvas& canvas,
                const RollingCamera& camera,
                const Pose& pose,
                const SolidModel& model,
                const std::vector<Vector3d>& points_w) {
  constexpr std::size_t kAtOnce = 10'000;  // the indices of their corners fit into 16 bits
  std::vector<Vector3d> points_c;
  std::vector<Vector2d> screen;
  for (const Vector3d& point : points_w) {
    points_c.push_back(to_camera(pose, point));
    const bool in_front = points_c.back().z() > 0;
    screen.push_back(in_front ? to_screen(canvas.mapping, project(camera, points_c.back()))
                              : Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
  }
  std::vector<DepthAndTriangle> far_to_near;
  for (std::size_t i = 0; i < model.triangles.size(); ++i) {
    const auto seen = [&](int corner) { return screen[corner].allFinite(); };
    if (!std::ranges::all_of(model.triangles[i], seen)) continue;
    double depth = 0;
    for (const int corner : model.triangles[i]) depth += points_c[corner].norm();
    far_to_near.emplace_back(-depth, i);
  }
  std::ranges::sort(far_to_near);
  for (std::size_t first = 0; first < far_to_near.size(); first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, far_to_near.size() - first);
    fill_triangles(canvas.list, model, screen, std::span(far_to_near).subspan(first, count));
  }
}

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

}  // namespace gpo
