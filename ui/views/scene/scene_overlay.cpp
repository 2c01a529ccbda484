// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/plane_names.h"
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/context/window_image.h"
#include "ui/look/numbers.h"
#include "ui/views/overlay/overlay.h"
#include "ui/views/overlay/track_colors.h"
#include "ui/views/image/image_view.h"
#include "ui/views/image/image_texture.h"
#include "ui/views/scene/plane_grid.h"
#include "ui/views/scene/scene_geometry.h"
#include "ui/views/scene/scene_view.h"
#include "ui/views/scene/uncertainty_geometry.h"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace gpo {

namespace {

using Eigen::Vector3d;

/// Lines and faces in space on their way to the screen.
struct Projection {
  ImDrawList& list;
  ScreenRect rect;
  OrbitCamera camera;

  std::optional<ImVec2> at(const Vector3d& point) const {
    const auto pixel = view_pixel(camera, point, rect.size);
    return pixel ? std::optional(to_imgui(rect.min + *pixel)) : std::nullopt;
  }
  void line(const Vector3d& a, const Vector3d& b, std::uint32_t rgb, float width_px) const {
    const auto visible = in_front(camera, a, b);
    if (!visible) return;
    const auto from = at((*visible)[0]), to = at((*visible)[1]);
    if (from && to) list.AddLine(*from, *to, imgui_color(rgb), width_px * overlay_scale());
  }
  void closed(std::span<const Vector3d> points, std::uint32_t rgb, float width_px) const {
    for (std::size_t i = 0; i < points.size(); ++i)
      line(points[i], points[(i + 1) % points.size()], rgb, width_px);
  }
  /// Its border is to be drawn, too: it is not smooth.
  void face(std::span<const Vector3d> corners, std::uint32_t rgb, double alpha) const {
    std::vector<ImVec2> pixels;
    for (const Vector3d& corner : corners) {
      const auto pixel = at(corner);
      if (!pixel) return;
      pixels.push_back(*pixel);
    }
    const ImDrawListFlags flags = list.Flags;
    list.Flags &= ~ImDrawListFlags_AntiAliasedFill;
    const int count = static_cast<int>(pixels.size());
    list.AddConvexPolyFilled(pixels.data(), count, imgui_color(rgb, alpha));
    list.Flags = flags;
  }
  void frustum(const std::array<Vector3d, 6>& corners, std::uint32_t rgb, float width_px) const {
    for (int k = 1; k <= 4; ++k) line(corners[0], corners[k], rgb, width_px);
    closed(std::span(corners).subspan(1, 4), rgb, width_px);
  }
};

void draw_true_camera(const Projection& projection,
                      const Inspection& inspection,
                      int frame_in_window) {
  const auto T_est_true = estimate_from_truth(inspection);
  if (!T_est_true) return;
  const auto pose = true_camera(inspection, *T_est_true, frame_in_window);
  if (!pose) return;
  const double depth = 0.75 * frustum_depth(inspection);
  projection.frustum(frustum(inspection.recording->camera, *pose, depth), color_of(Role::truth), 2);
}

void draw_uncertainty(const Projection& projection,
                      const Inspection& inspection,
                      int frame_in_window,
                      double enlarged) {
  const Initialization& estimate = *inspection.initialization;
  const auto& covariances = estimate.uncertainty->center_covariances;
  if (frame_in_window == 0 || frame_in_window >= std::ssize(covariances)) return;
  const auto ellipsoid = confidence_ellipsoid(
      estimate.cameras[frame_in_window].p_wc, covariances[frame_in_window], enlarged);
  for (const auto& line : ellipsoid) projection.closed(line, color_of(Role::uncertain), 1.2F);
}

/// The frame's camera as it is drawn: which edge of its picture is up is marked. The reference
/// camera keeps its color.
struct MarkedFrustum {
  std::array<Vector3d, 6> corners;
  std::array<Vector3d, 3> mark;
  std::uint32_t rgb;

  void draw_faces(const Projection& projection) const {
    projection.face(std::span(corners).subspan(1, 4), rgb, 0.2);
    projection.face(mark, rgb, 0.4);
  }
  void draw_lines(const Projection& projection) const {
    projection.frustum(corners, rgb, 2.6F);
    projection.closed(mark, rgb, 2.6F);
  }
};
MarkedFrustum marked_frustum(const Inspection& inspection, int frame_in_window) {
  const std::uint32_t method = inspection.settings.options.method.row().rgb;
  const auto corners = frustum(inspection.recording->camera,
                               inspection.initialization->cameras[frame_in_window],
                               frustum_depth(inspection));
  return {corners,
          {corners[1], corners[2], corners[5]},
          frame_in_window == 0 ? color_of(Role::reference)
                               : mixed_rgb(method, color_of(Role::text), 0.35)};
}

/// What of the scene belongs to one frame only: its camera, its true camera and its uncertainty,
/// drawn over the rendered rest, so that a step does not render the scene anew. `frame_in_window`
/// may be outside of the window.
void draw_scene_moment(ImDrawList& list,
                       const ScreenRect& rect,
                       const Inspection& inspection,
                       int frame_in_window,
                       const OrbitCamera& camera,
                       const ViewOptions& options) {
  const Projection projection{list, rect, camera};
  const bool in_window = frame_in_window >= 0 && frame_in_window < inspection.window->frame_count();
  if (!in_window) return;
  const Initialization& estimate = *inspection.initialization;
  std::optional<MarkedFrustum> marked;
  if (estimate.ok && frame_in_window < std::ssize(estimate.cameras))
    marked = marked_frustum(inspection, frame_in_window);
  // Faces first: they would hide the lines behind them.
  if (marked) marked->draw_faces(projection);
  if (options.show.truth) draw_true_camera(projection, inspection, frame_in_window);
  if (marked && shows_uncertainty(inspection, options))
    draw_uncertainty(projection, inspection, frame_in_window, options.show.uncertainty);
  if (marked) marked->draw_lines(projection);
}

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Text around a point, on a dark rim.
void draw_label(ImDrawList& list, const Vector2d& at, std::uint32_t rgb, const char* text) {
  const ImFont* f = font(Font::bold);
  const ImVec2 size = f->CalcTextSizeA(f->FontSize, 1e6F, 0, text);
  const ImVec2 corner(std::round(static_cast<float>(at.x()) - size.x / 2),
                      std::round(static_cast<float>(at.y()) - size.y / 2));
  for (const float dx : {-1.0F, 1.0F})
    for (const float dy : {-1.0F, 1.0F})
      list.AddText(f,
                   f->FontSize,
                   ImVec2(corner.x + dx, corner.y + dy),
                   imgui_color(Role::background, 0.7),
                   text);
  list.AddText(f, f->FontSize, corner, imgui_color(rgb), text);
}

constexpr std::array kAxes = {Role::axis_x, Role::axis_y, Role::axis_z};

/// The world's axes, at the reference camera.
void draw_axes(ImDrawList& list,
               const ScreenRect& rect,
               const Inspection& inspection,
               const OrbitCamera& camera) {
  const double length = axes_length(inspection);
  const auto on_screen = [&](const Vector3d& point) -> std::optional<Vector2d> {
    const auto pixel = view_pixel(camera, point, rect.size);
    return pixel ? std::optional<Vector2d>(rect.min + *pixel) : std::nullopt;
  };
  const auto origin = on_screen(Vector3d::Zero());
  for (int axis = 0; axis < 3 && origin; ++axis) {
    const auto tip = on_screen(length * Vector3d::Unit(axis));
    if (!tip) continue;
    const std::uint32_t rgb = color_of(kAxes[axis]);
    list.AddLine(to_imgui(*origin), to_imgui(*tip), imgui_color(rgb), 2.4F * overlay_scale());
    const Vector2d along =
        (*tip - *origin).norm() > 1 ? Vector2d((*tip - *origin).normalized()) : Vector2d(0, 0);
    const std::array<const char*, 3> names = {"x", "y", "z"};
    draw_label(list, *tip + 9 * overlay_scale() * along, rgb, names[axis]);
  }
}

/// From the reference camera upwards.
void draw_up(ImDrawList& list,
             const ScreenRect& rect,
             const Inspection& inspection,
             const OrbitCamera& camera) {
  const Vector3d up = -inspection.inertial->gravity_m_s2.normalized();
  const auto from = view_pixel(camera, Vector3d::Zero(), rect.size);
  const auto to = view_pixel(camera, 1.6 * axes_length(inspection) * up, rect.size);
  if (!from || !to || (*to - *from).norm() < 1) return;
  const float s = overlay_scale();
  const Vector2d along = (*to - *from).normalized(), across(-along.y(), along.x());
  const Vector2d tip = rect.min + *to, neck = tip - 9 * s * along;
  const ImU32 color = imgui_color(Role::gravity);
  list.AddLine(to_imgui(rect.min + *from), to_imgui(neck), color, 2 * s);
  list.AddTriangleFilled(
      to_imgui(tip), to_imgui(neck + 4.5 * s * across), to_imgui(neck - 4.5 * s * across), color);
  draw_label(list, tip + 11 * s * along, color_of(Role::gravity), "up");
}

bool shows_up(const Inspection& inspection, const ViewOptions& options) {
  return options.show.gravity && inspection.inertial && inspection.inertial->ok;
}

std::optional<double> shown_scale(const Inspection& inspection) {
  if (inspection.evaluation && inspection.evaluation->scale) return inspection.evaluation->scale;
  if (const auto T_est_true = estimate_from_truth(inspection)) return 1 / T_est_true->scale;
  return known_scale(inspection);
}

std::string bar_text(double length, bool meters) {
  if (!meters) return fmt::format("{:g} d", length);
  if (length < 0.01) return fmt::format("{:g} mm", length * 1e3);
  if (length < 1) return fmt::format("{:g} cm", length * 1e2);
  return fmt::format("{:g} m", length);
}

std::string cell_text(const Inspection& inspection, const ViewOptions& options) {
  const auto meters = shown_scale(inspection);
  const double cell = plane_grid(inspection, cube_side(inspection, options.cube_side)).cell;
  return bar_text(meters.value_or(1) * cell, meters.has_value());
}

/// In meters, where the accelerometer tells them.
std::string side_text(const Inspection& inspection, const ViewOptions& options) {
  const auto scale = known_scale(inspection);
  if (!scale) return "";
  return ", " + length_text(*scale * cube_side(inspection, options.cube_side));
}

std::vector<LegendRow> legend_rows(const Inspection& inspection,
                                   int frame_in_window,
                                   const ViewOptions& options) {
  const Method& method = inspection.settings.options.method.row();
  std::vector<LegendRow> rows;
  if (inspection.initialization->ok) {
    rows.push_back({Sign::frustum, method.rgb, method.title + " cameras"});
    if (frame_in_window > 0)
      rows.push_back({Sign::frustum, color_of(Role::reference), "reference frame"});
    rows.push_back({Sign::square,
                    color_of(Role::plane),
                    "estimated plane, cells of " + cell_text(inspection, options)});
    rows.push_back({options.colors ? Sign::none : Sign::dot,
                    color_of(Role::map_point),
                    fmt::format("{} map points", inspection.initialization->points.size())});
    if (options.colors)
      for (LegendRow& row : legend_rows(*options.colors)) rows.push_back(std::move(row));
    if (options.show.cube && inspection.cube)
      rows.push_back(
          {Sign::square, color_of(Role::cube_base), "cube" + side_text(inspection, options)});
    if (shows_up(inspection, options))
      rows.push_back({Sign::line,
                      color_of(Role::gravity),
                      "up, certain to " + angle_text(inspection.inertial->gravity_sigma_deg)});
  }
  if (inspection.initialization->refused)
    rows.push_back(
        {Sign::frustum, color_of(Role::bad), "what " + method.title + " found, refused"});
  if (shows_uncertainty(inspection, options)) {
    const int times = options.show.uncertainty;
    rows.push_back({Sign::circle,
                    color_of(Role::uncertain),
                    "95 % of centers and normal" +
                        (times > 1 ? fmt::format(", enlarged {}\u00d7", times) : "")});
  }
  if (options.show.truth && estimate_from_truth(inspection))
    rows.push_back({Sign::frustum,
                    color_of(Role::truth),
                    inspection.initialization->ok && inspection.truth->plane
                        ? "true cameras and plane"
                        : "true cameras"});
  return rows;
}

/// True to scale where the view's target is. In meters by the truth, else by the accelerometer.
void draw_scale_bar(ImDrawList& list,
                    const ScreenRect& rect,
                    const Inspection& inspection,
                    const OrbitCamera& camera) {
  const auto meters = shown_scale(inspection);
  const float s = overlay_scale();
  const double pixels = pixels_a_unit(camera, rect.size.y()) / meters.value_or(1);
  const double length = nice_length(140 * s / pixels);
  const auto width = static_cast<float>(length * pixels);
  const ImVec2 end = to_imgui(rect.min + Vector2d(rect.size.x() - 16 * s, 36 * s));
  const ImU32 color = imgui_color(Role::text);
  const ImVec2 start(end.x - width, end.y);
  list.AddLine(start, end, color, 2 * s);
  for (const float x : {start.x, end.x})
    list.AddLine(ImVec2(x, end.y - 5 * s), ImVec2(x, end.y + s), color, 2 * s);
  const std::string text = bar_text(length, meters.has_value());
  const auto half = static_cast<float>(text_width(Font::small, text)) / 2;
  write_text(list,
             Font::small,
             {end.x - width / 2 - half, end.y - font(Font::small)->FontSize - 7 * s},
             text);
}

}  // namespace

void draw_scene_view(ImDrawList& list,
                     const ScreenRect& rect,
                     SceneView& view,
                     const Inspection& inspection,
                     int frame,
                     const OrbitCamera& camera,
                     const ViewOptions& options) {
  const unsigned texture = view.render(inspection,
                                       camera,
                                       options,
                                       static_cast<int>(rect.size.x()),
                                       static_cast<int>(rect.size.y()));
  if (texture == 0) return;
  const ImVec2 low = to_imgui(rect.min), high = to_imgui(rect.min + rect.size);
  list.PushClipRect(low, high, true);
  mark_content(list, view.renders());
  list.AddImage(imgui_texture(texture), low, high, ImVec2(0, 1), ImVec2(1, 0));
  const int frame_in_window = frame - inspection.window->start;
  draw_scene_moment(list, rect, inspection, frame_in_window, camera, options);
  const bool shows_something =
      !found_cameras(*inspection.initialization).empty() || estimate_from_truth(inspection);
  if (shows_something) draw_axes(list, rect, inspection, camera);
  if (shows_up(inspection, options)) draw_up(list, rect, inspection, camera);
  if (options.show.legend)
    draw_legend_strip(list, rect, legend_rows(inspection, frame_in_window, options));
  if (shows_something) draw_scale_bar(list, rect, inspection, camera);
  if (!inspection.initialization->ok) {
    const Vector2d legend(0, options.show.legend ? 20 * overlay_scale() : 0);
    draw_badge(list,
               {rect.min, rect.size - legend},
               color_of(Role::warning),
               "not initialized",
               inspection.initialization->reason);
  }
  list.PopClipRect();
}

}  // namespace gpo
