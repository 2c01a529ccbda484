// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/image/track_highlight.h"

#include "engine/inspection/plane_names.h"
#include "engine/inspection/studies/plane_patches.h"
#include "engine/window/tracks.h"
#include "ui/context/theme.h"
#include "ui/look/numbers.h"
#include "ui/views/overlay/overlay.h"

#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// The nearest of several places; add them one by one.
struct Nearest {
  Vector2d to;
  double distance;  ///< begins as how far one may be
  std::optional<int> index = {};

  void add(int candidate, const Vector2d& at) {
    const double d = (at - to).norm();
    if (d > distance) return;
    distance = d;
    index = candidate;
  }
};

/// A thick ring that shows on any ground.
void draw_ring(ImDrawList& list, const Vector2d& at, double radius, std::uint32_t rgb) {
  const float s = overlay_scale();
  const auto r = static_cast<float>(radius) * s;
  list.AddCircle(to_imgui(at), r, imgui_color(Role::background, 0.8), 32, 4.5F * s);
  list.AddCircle(to_imgui(at), r, imgui_color(rgb), 32, 2.2F * s);
}

void draw_way(ImDrawList& list,
              const Tracks& tracks,
              int column,
              const ImageMapping& mapping,
              double alpha) {
  std::vector<ImVec2> points;
  for (int i = 0; i < tracks.frame_count(); ++i)
    if (tracks.seen(i, column))
      points.push_back(to_imgui(to_screen(mapping, tracks.raw_px[i].col(column))));
  const auto count = static_cast<int>(points.size());
  const float s = overlay_scale();
  list.AddPolyline(points.data(), count, imgui_color(Role::background, 0.6 * alpha), 0, 4.2F * s);
  list.AddPolyline(points.data(), count, imgui_color(Role::selected, alpha), 0, 2 * s);
}

const MapPoint* point_of(const Inspection& inspection, int column) {
  const auto& points = inspection.initialization->points;
  const auto found = std::ranges::find(points, column, &MapPoint::track);
  return found == points.end() ? nullptr : &*found;
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
    if (tracks.seen(frame_in_window, column))
      nearest.add(column, to_screen(mapping, tracks.raw_px[frame_in_window].col(column)));
  return nearest.index;
}

std::optional<int> point_at(const Inspection& inspection,
                            const OrbitCamera& camera,
                            const Vector2d& view_size_px,
                            const Vector2d& pixel,
                            double reach) {
  Nearest nearest{pixel, reach};
  for (const MapPoint& point : inspection.initialization->points)
    if (const auto at = view_pixel(camera, point.position, view_size_px))
      nearest.add(point.track, *at);
  for (const PlanePatch& patch : plane_patches(inspection))
    for (const MapPoint& point : patch.points)
      if (const auto at = view_pixel(camera, point.position, view_size_px))
        nearest.add(point.track, *at);
  return nearest.index;
}

std::optional<int> camera_at(const Inspection& inspection,
                             const OrbitCamera& camera,
                             const Vector2d& view_size_px,
                             const Vector2d& pixel,
                             double reach) {
  Nearest nearest{pixel, reach};
  const auto& cameras = inspection.initialization->cameras;
  for (int i = 0; i < static_cast<int>(cameras.size()); ++i)
    if (const auto at = view_pixel(camera, cameras[i].p_wc, view_size_px)) nearest.add(i, *at);
  return nearest.index;
}

std::optional<Vector3d> plane_at(const Inspection& inspection,
                                 const OrbitCamera& camera,
                                 const Vector2d& view_size_px,
                                 const Vector2d& pixel) {
  if (!inspection.initialization->ok) return std::nullopt;
  return intersect(inspection.initialization->plane,
                   {view_axes(camera), eye(camera)},
                   view_axes(camera).transpose() * view_ray(camera, pixel, view_size_px));
}

void draw_highlight_in_image(ImDrawList& list,
                               const ScreenRect& rect,
                               const Inspection& inspection,
                               int frame_in_window,
                               const ImageMapping& mapping,
                               const Highlight& highlight) {
  const Tracks& tracks = *inspection.tracks;
  if (frame_in_window < 0 || frame_in_window >= tracks.frame_count()) return;
  list.PushClipRect(to_imgui(rect.min), to_imgui(rect.min + rect.size), true);
  if (highlight.focus) draw_way(list, tracks, *highlight.focus, mapping, 1);
  if (highlight.hovered && highlight.hovered != highlight.focus)
    draw_way(list, tracks, *highlight.hovered, mapping, 0.7);
  const auto ring = [&](int column, double radius, std::uint32_t rgb) {
    if (tracks.seen(frame_in_window, column))
      draw_ring(list, to_screen(mapping, tracks.raw_px[frame_in_window].col(column)), radius, rgb);
  };
  for (const int column : highlight.picked)
    ring(column, column == highlight.focus ? 10 : 8, color_of(Role::selected));
  if (highlight.hovered) ring(*highlight.hovered, 11, color_of(Role::pointed_at));
  list.PopClipRect();
}

std::string distance_text(const Inspection& inspection, const Vector3d& a, const Vector3d& b) {
  const auto meters = known_scale(inspection);
  const double distance = (b - a).norm();
  return meters ? length_text(*meters * distance) : fmt::format("{:.3f} d", distance);
}

namespace {

/// From one picked point to the other, where both are in the map and in view.
template <class OnScreen>
void draw_distance(ImDrawList& list,
                   const Inspection& inspection,
                   int column_a,
                   int column_b,
                   const OnScreen& on_screen) {
  const MapPoint* a = point_of(inspection, column_a);
  const MapPoint* b = point_of(inspection, column_b);
  if (a == nullptr || b == nullptr) return;
  const auto from = on_screen(a->position), to = on_screen(b->position);
  if (!from || !to) return;
  const float s = overlay_scale();
  list.AddLine(to_imgui(*from), to_imgui(*to), imgui_color(Role::selected), 1.6F * s);
  const std::string text = distance_text(inspection, a->position, b->position);
  const Vector2d at = (*from + *to) / 2 + Vector2d(8 * s, 4 * s);
  const Vector2d size(text_width(Font::small, text) + 8 * s, 18 * s);
  list.AddRectFilled(to_imgui(at), to_imgui(at + size), imgui_color(Role::background, 0.8));
  write_text(list, Font::small, at + Vector2d(4 * s, 2 * s), text);
}

}  // namespace

void draw_highlight_in_scene(ImDrawList& list,
                             const ScreenRect& rect,
                             const Inspection& inspection,
                             int frame_in_window,
                             const OrbitCamera& camera,
                             const Highlight& highlight) {
  const Initialization& result = *inspection.initialization;
  const float s = overlay_scale();
  const auto on_screen = [&](const Vector3d& point) -> std::optional<Vector2d> {
    const auto pixel = view_pixel(camera, point, rect.size);
    return pixel ? std::optional<Vector2d>(rect.min + *pixel) : std::nullopt;
  };
  const auto draw_rays = [&](int column, const Vector2d& point, double alpha) {
    for (int i = 0; i < static_cast<int>(result.cameras.size()); ++i) {
      if (!inspection.tracks->seen(i, column)) continue;
      const auto center = on_screen(result.cameras[i].p_wc);
      if (!center) continue;
      const bool now = i == frame_in_window;
      const bool inlier = inspection.window->inlier[i][column];
      list.AddLine(to_imgui(point),
                   to_imgui(*center),
                   imgui_color(inlier ? Role::inlier : Role::outlier, now ? alpha : 0.35 * alpha),
                   (now ? 2 : 1) * s);
    }
  };
  const auto draw_point = [&](int column, double radius, std::uint32_t rgb, bool rays) {
    const MapPoint* point = point_of(inspection, column);
    const auto at = point != nullptr ? on_screen(point->position) : std::nullopt;
    if (!at) return;
    if (rays) draw_rays(column, *at, 1);
    draw_ring(list, *at, radius, rgb);
  };
  list.PushClipRect(to_imgui(rect.min), to_imgui(rect.min + rect.size), true);
  if (highlight.picked.size() == 2)
    draw_distance(list, inspection, highlight.picked[0], highlight.picked[1], on_screen);
  for (const int column : highlight.picked)
    draw_point(column,
               column == highlight.focus ? 8 : 6,
               color_of(Role::selected),
               column == highlight.focus);
  if (highlight.hovered) draw_point(*highlight.hovered, 9, color_of(Role::pointed_at), true);
  const int cameras = static_cast<int>(result.cameras.size());
  if (highlight.camera && *highlight.camera >= 0 && *highlight.camera < cameras)
    if (const auto at = on_screen(result.cameras[*highlight.camera].p_wc))
      draw_ring(list, *at, 9, color_of(Role::pointed_at));
  list.PopClipRect();
}

}  // namespace gpo
