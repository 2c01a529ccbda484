// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/studies.h"
#include "engine/window/tracks.h"
#include "ui/views/image/image_geometry.h"
#include "ui/views/image/image_view.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

/// The nearest of the places that are added.
struct Nearest {
  Vector2d to;
  double distance;  ///< initially the largest allowed one
  int index = -1;

  std::optional<int> found() const { return index < 0 ? std::nullopt : std::optional(index); }
  void add(int candidate, const std::optional<Vector2d>& at) {
    if (!at || (*at - to).norm() > distance) return;
    distance = (*at - to).norm();
    index = candidate;
  }
};

/// Draws a thick ring that stands out on any ground.
void draw_ring(ImDrawList& list, const Vector2d& at, double radius, Role role) {
  const float s = overlay_scale();
  const auto r = static_cast<float>(radius) * s;
  list.AddCircle(to_imgui(at), r, imgui_color(Role::background, 0.8), 32, 4.5F * s);
  list.AddCircle(to_imgui(at), r, imgui_color(role), 32, 2.2F * s);
}

void draw_path(
    ImDrawList& list, const Tracks& tracks, int column, const ImageMapping& mapping, double alpha) {
  std::vector<ImVec2> points;
  for (int i = 0; i < tracks.frame_count(); ++i)
    if (tracks.seen(i, column))
      points.push_back(to_imgui(to_screen(mapping, tracks.raw_px[i].col(column))));
  const auto count = static_cast<int>(points.size());
  const float s = overlay_scale();
  list.AddPolyline(points.data(), count, imgui_color(Role::background, 0.6 * alpha), 0, 4.2F * s);
  list.AddPolyline(points.data(), count, imgui_color(Role::selected, alpha), 0, 2 * s);
}

/// Draws an arrow from a track to the place that looks alike.
void draw_second_match(ImDrawList& list, const Vector2d& from, const Vector2d& to) {
  const double s = overlay_scale(), length = (to - from).norm();
  if (!(length > 0)) return;
  const Vector2d back = (from - to) / length * std::min(6 * s, length / 2);
  const Vector2d aside = Vector2d(-back.y(), back.x()) / 2;
  const std::array head = {to_imgui(to + back + aside), to_imgui(to), to_imgui(to + back - aside)};
  for (const auto& [color, width] :
       {std::pair{imgui_color(Role::background, 0.6), 3.0}, {imgui_color(Role::warning), 1.2}}) {
    const auto thick = static_cast<float>(width * s);
    list.AddLine(to_imgui(from), to_imgui(to), color, thick);
    list.AddPolyline(head.data(), static_cast<int>(head.size()), color, 0, thick);
  }
}

/// Draws a line with its length beside it.
void draw_length(ImDrawList& list,
                 const Vector2d& from,
                 const Vector2d& to,
                 const std::string& text) {
  const float s = overlay_scale();
  list.AddLine(to_imgui(from), to_imgui(to), imgui_color(Role::selected), 1.6F * s);
  const Vector2d corner = (from + to) / 2 + Vector2d(8 * s, 4 * s);
  const Vector2d size(text_width(Font::small, text) + 8 * s, 18 * s);
  list.AddRectFilled(to_imgui(corner), to_imgui(corner + size), imgui_color(Role::background, 0.8));
  write_text(list, Font::small, corner + Vector2d(4 * s, 2 * s), text);
}

struct SceneHighlight : Area {
  const FrameView& view;
  const OrbitCamera& camera;

  const std::vector<Pose>& cameras() const { return view.inspection.initialization->cameras; }
  std::optional<Vector2d> at(const Vector3d& point) const { return on_screen(camera, point, rect); }
  /// Returns the map point of a track; null if it has none.
  const Vector3d* point_of(int column) const {
    const auto& points = view.inspection.initialization->points;
    const auto found = std::ranges::find(points, column, &MapPoint::track);
    return found == points.end() ? nullptr : &found->position;
  }

  void draw_rays(int column, const Vector2d& point) const {
    for (int i = 0; i < std::ssize(cameras()); ++i) {
      const auto center = at(cameras()[i].p_wc);
      if (!view.inspection.tracks->seen(i, column) || !center) continue;
      const bool now = i == view.in_window();
      const Role role = view.inspection.window->inlier[i][column] ? Role::inlier : Role::outlier;
      const float width = (now ? 2.0F : 1.0F) * overlay_scale();
      list.AddLine(to_imgui(point), to_imgui(*center), imgui_color(role, now ? 1 : 0.35), width);
    }
  }
  void draw_point(int column, double radius, Role role, bool rays) const {
    const Vector3d* point = point_of(column);
    const auto pixel = point != nullptr ? at(*point) : std::nullopt;
    if (!pixel) return;
    if (rays) draw_rays(column, *pixel);
    draw_ring(list, *pixel, radius, role);
  }
  void draw_distance(int column_a, int column_b) const {
    const Vector3d *a = point_of(column_a), *b = point_of(column_b);
    if (a == nullptr || b == nullptr) return;
    const auto from = at(*a), to = at(*b);
    if (from && to) draw_length(list, *from, *to, distance_text(view.inspection, *a, *b));
  }
};

/// Returns whether a point of the patch's plane is inside of its border.
bool covers(const PlanePatch& patch, const Vector3d& point) {
  const auto along = [&](const Vector3d& corner) {
    const Vector3d side = corner - patch.corners[0];
    return side.dot(point - patch.corners[0]) / side.squaredNorm();
  };
  const double u = along(patch.corners[1]), v = along(patch.corners[3]);
  return u >= 0 && u <= 1 && v >= 0 && v <= 1;
}

std::string color_text(const cv::Mat& bgr, const Vector2d& raw_px) {
  const cv::Point pixel(static_cast<int>(std::lround(raw_px.x())),
                        static_cast<int>(std::lround(raw_px.y())));
  if (bgr.empty() || !cv::Rect({0, 0}, bgr.size()).contains(pixel)) return "";
  const auto& at = bgr.at<cv::Vec3b>(pixel);
  if (at[0] == at[1] && at[1] == at[2]) return fmt::format("   gray {}", at[0]);
  return fmt::format("   RGB {} {} {}", at[2], at[1], at[0]);
}

/// Formats the distance of the plane under the pixel from the frame's camera, along the ray.
std::string plane_text(const Inspection& inspection, int frame, const Vector2d& raw_px) {
  const Initialization& result = *inspection.initialization;
  if (!result.ok || frame < 0 || frame >= std::ssize(result.cameras)) return "";
  const auto number = plane_near(inspection, frame, raw_px);
  if (!number) return "";
  const std::string title = plane_title(inspection, *number);
  const Plane* plane = estimated_plane(inspection, *number);
  const auto point =
      plane == nullptr ? std::nullopt : point_on_plane(inspection, frame, raw_px, *plane);
  if (!point) return "   on " + title;
  const double away = (*point - result.cameras[frame].p_wc).norm();
  const auto meters = known_scale(inspection);
  return fmt::format("   {} away on {}",
                     meters ? length_text(*meters * away) : fmt::format("{:.2f} d", away),
                     title);
}

}  // namespace

std::optional<int> track_at(const Inspection& inspection,
                            int frame_in_window,
                            const ImageMapping& mapping,
                            const Vector2d& screen_px,
                            double reach) {
  const Tracks& tracks = *inspection.tracks;
  if (frame_in_window < 0 || frame_in_window >= tracks.frame_count()) return std::nullopt;
  Nearest nearest{screen_px, reach};
  for (int column = 0; column < tracks.track_count(); ++column)
    if (const auto place = place_of_sign(inspection, frame_in_window, column))
      nearest.add(column, to_screen(mapping, *place));
  return nearest.found();
}

std::optional<int> point_at(const Inspection& inspection, const ScenePixel& at, double reach) {
  Nearest nearest{at.pixel, reach};
  const auto add = [&](const std::vector<MapPoint>& points) {
    for (const MapPoint& point : points) nearest.add(point.track, at.pixel_of(point.position));
  };
  add(inspection.initialization->points);
  for (const PlanePatch& patch : plane_patches(inspection)) add(patch.points);
  return nearest.found();
}

std::optional<int> camera_at(const Inspection& inspection, const ScenePixel& at, double reach) {
  Nearest nearest{at.pixel, reach};
  const auto& cameras = inspection.initialization->cameras;
  for (int i = 0; i < std::ssize(cameras); ++i) nearest.add(i, at.pixel_of(cameras[i].p_wc));
  return nearest.found();
}

std::optional<Vector3d> point_on_plane(const Plane& plane, const ScenePixel& at) {
  const Eigen::Matrix3d axes = view_axes(at.camera);
  const Vector3d ray = axes.transpose() * view_ray(at.camera, at.pixel, at.view_size_px);
  return intersect(plane, {axes, eye(at.camera)}, ray);
}

std::optional<CubeAnchor> cube_at(const Inspection& inspection, double side, const ScenePixel& at) {
  std::vector<CubeAnchor> cubes = all_cubes(inspection);
  std::erase_if(cubes, [&](const CubeAnchor& cube) {
    const auto corners = cube_corners(cube, side);
    return std::ranges::none_of(kCubeFaces, [&](const auto& face) {
      Outline outline;
      for (const int corner : face)
        if (const auto pixel = at.pixel_of(corners[corner])) outline.push_back(*pixel);
      return is_inside(outline, at.pixel);
    });
  });
  const auto nearest = std::ranges::min_element(
      cubes, {}, [&](const CubeAnchor& cube) { return (cube.origin - eye(at.camera)).norm(); });
  return nearest == cubes.end() ? std::nullopt : std::optional(*nearest);
}

std::optional<PlanePoint> plane_at(const Inspection& inspection, const ScenePixel& at) {
  if (!inspection.initialization->ok) return std::nullopt;
  std::optional<PlanePoint> nearest;
  double distance = std::numeric_limits<double>::infinity();
  for (const PlanePatch& patch : plane_patches(inspection)) {
    const Plane plane{patch.normal, -patch.normal.dot(patch.corners[0])};
    const auto point = point_on_plane(plane, at);
    if (!point || !covers(patch, *point)) continue;
    const double away = (*point - eye(at.camera)).norm();
    if (away >= distance) continue;
    distance = away;
    nearest = {.plane = patch.number, .point = *point};
  }
  if (nearest) return nearest;
  const auto point = point_on_plane(inspection.initialization->plane, at);
  if (!point) return std::nullopt;
  return PlanePoint{.plane = inspection.window->leader, .point = *point};
}

void draw_highlight_in_image(const Area& area,
                             const FrameView& view,
                             const ImageMapping& mapping,
                             const Highlight& highlight) {
  const Tracks& tracks = *view.inspection.tracks;
  const int frame = view.in_window();
  if (frame < 0 || frame >= tracks.frame_count()) return;
  ImDrawList& list = area.list;
  area.clip();
  if (highlight.focus) draw_path(list, tracks, *highlight.focus, mapping, 1);
  if (highlight.hovered && highlight.hovered != highlight.focus)
    draw_path(list, tracks, *highlight.hovered, mapping, 0.7);
  const auto ring = [&](int column, double radius, Role role) {
    if (const auto place = place_of_sign(view.inspection, frame, column))
      draw_ring(list, to_screen(mapping, *place), radius, role);
  };
  for (const int column : highlight.picked)
    ring(column, column == highlight.focus ? 10 : 8, Role::selected);
  if (frame == 0 && find_finding(view.inspection.findings, "repeated-texture") != nullptr) {
    for (const int column : highlight.picked) {
      const Vector2d from_px = tracks.raw_px[0].col(column);
      draw_second_match(list,
                        to_screen(mapping, from_px),
                        to_screen(mapping, from_px + tracks.repetition->period_px.col(column)));
    }
  }
  if (highlight.hovered) ring(*highlight.hovered, 11, Role::pointed_at);
  list.PopClipRect();
}

void draw_points(const Area& area,
                 const FrameView& view,
                 const ImageMapping& mapping,
                 std::span<const Vector2d> raw_px) {
  std::vector<Vector2d> at;
  std::vector<Vector3d> points;
  area.clip();
  for (const Vector2d& pixel : raw_px) {
    at.push_back(to_screen(mapping, pixel));
    draw_ring(area.list, at.back(), 4, Role::selected);
    if (!view.inside()) continue;
    const auto number = plane_near(view.inspection, view.in_window(), pixel);
    const Plane* plane = number ? estimated_plane(view.inspection, *number) : nullptr;
    if (plane == nullptr) continue;
    if (const auto point = point_on_plane(view.inspection, view.in_window(), pixel, *plane))
      points.push_back(*point);
  }
  if (at.size() == 2)
    draw_length(
        area.list,
        at[0],
        at[1],
        points.size() == 2 ? distance_text(view.inspection, points[0], points[1]) : "on no plane");
  area.list.PopClipRect();
}

void draw_highlight_in_scene(const Area& area,
                             const FrameView& view,
                             const OrbitCamera& camera,
                             const Highlight& highlight) {
  const SceneHighlight scene{area, view, camera};
  area.clip();
  if (highlight.picked.size() == 2) scene.draw_distance(highlight.picked[0], highlight.picked[1]);
  for (const int column : highlight.picked) {
    const bool focus = column == highlight.focus;
    scene.draw_point(column, focus ? 8 : 6, Role::selected, focus);
  }
  if (highlight.hovered) scene.draw_point(*highlight.hovered, 9, Role::pointed_at, true);
  const int hovered = highlight.camera.value_or(-1);
  if (hovered >= 0 && hovered < std::ssize(scene.cameras()))
    if (const auto at = scene.at(scene.cameras()[hovered].p_wc))
      draw_ring(area.list, *at, 9, Role::pointed_at);
  area.list.PopClipRect();
}

std::string distance_text(const Inspection& inspection, const Vector3d& a, const Vector3d& b) {
  const auto meters = known_scale(inspection);
  const double distance = (b - a).norm();
  return meters ? length_text(*meters * distance) : fmt::format("{:.3f} d", distance);
}

std::string pixel_text(const PixelReadout& readout) {
  const auto& [inspection, frame, camera, bgr, raw_px, scale] = readout;
  const bool inside = raw_px.x() >= -0.5 && raw_px.y() >= -0.5 && raw_px.x() < camera.width - 0.5 &&
                      raw_px.y() < camera.height - 0.5;
  if (!inside) return "";
  std::string text = fmt::format("x {:.1f}  y {:.1f} px", raw_px.x(), raw_px.y());
  text += color_text(bgr, raw_px);
  if (inspection != nullptr)
    text += plane_text(*inspection, frame - inspection->window->start, raw_px);
  return text + fmt::format("   {:.0f} %", 100 * scale);
}

void draw_pixel_text(const Area& area, const std::string& text) {
  if (text.empty()) return;
  const float s = overlay_scale();
  const Vector2d size = text_size(Font::small, text);
  const Vector2d corner = area.rect.min + Vector2d(0, area.rect.size.y());
  const Vector2d at = (corner - Vector2d(0, size.y() + 6 * s)).array().round();
  const Vector2d end(std::round(at.x() + size.x() + 16 * s), corner.y());
  area.list.AddRectFilled(to_imgui(at), to_imgui(end), imgui_color(Role::background, 0.8));
  write_text(area.list, Font::small, at + Vector2d(8 * s, 3 * s), text);
}

void draw_pixel_grid(const Area& area, const ImageMapping& mapping) {
  constexpr double kLeastScale = 8;
  // Undistorted pixels are not squares.
  if (mapping.scale < kLeastScale * overlay_scale() || mapping.undistorted != nullptr) return;
  const ImU32 color = imgui_color(Role::text, 0.12);
  const Vector2d a = to_image(mapping, area.rect.min);
  const Vector2d b = to_image(mapping, area.rect.min + area.rect.size);
  const Vector2d first = a.cwiseMin(b).cwiseMax(0);
  const Vector2d last = (a.cwiseMax(b).array() + 1).min(mapping.raw_size.array());
  const int left = static_cast<int>(first.x()), top = static_cast<int>(first.y());
  const int right = static_cast<int>(last.x()), bottom = static_cast<int>(last.y());
  const auto line = [&](double u0, double v0, double u1, double v1) {
    area.list.AddLine(
        to_imgui(to_screen(mapping, {u0, v0})), to_imgui(to_screen(mapping, {u1, v1})), color);
  };
  for (int u = left; u <= right; ++u) line(u - 0.5, top - 0.5, u - 0.5, bottom - 0.5);
  for (int v = top; v <= bottom; ++v) line(left - 0.5, v - 0.5, right - 0.5, v - 0.5);
}

}  // namespace gpo
