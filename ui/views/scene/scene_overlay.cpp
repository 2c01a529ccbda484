// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/studies.h"
#include "ui/views/image/image_geometry.h"
#include "ui/views/scene/scene_view.h"

#include <fmt/format.h>

namespace gpo {
namespace {

struct SceneOverlay : Area {
  const FrameView& view;
  const OrbitCamera& camera;

  const Inspection& inspection() const { return view.inspection; }
  std::optional<Vector2d> at(const Vector3d& point) const { return on_screen(camera, point, rect); }
  void line(const Vector3d& a, const Vector3d& b, std::uint32_t rgb, float width_px) const {
    const auto visible = in_front(camera, a, b);
    if (!visible) return;
    const auto from = at((*visible)[0]), to = at((*visible)[1]);
    if (!from || !to) return;
    list.AddLine(to_imgui(*from), to_imgui(*to), imgui_color(rgb), width_px * overlay_scale());
  }
  void closed(std::span<const Vector3d> points, std::uint32_t rgb, float width_px) const {
    for (std::size_t i = 0; i < points.size(); ++i)
      line(points[i], points[(i + 1) % points.size()], rgb, width_px);
  }
  /// Without anti-aliasing: draw its border, too.
  void face(std::span<const Vector3d> corners, std::uint32_t rgb, double alpha) const {
    std::vector<ImVec2> pixels;
    for (const Vector3d& corner : corners) {
      const auto pixel = at(corner);
      if (!pixel) return;
      pixels.push_back(to_imgui(*pixel));
    }
    const ImDrawListFlags flags = list.Flags;
    list.Flags &= ~ImDrawListFlags_AntiAliasedFill;
    const int count = static_cast<int>(pixels.size());
    list.AddConvexPolyFilled(pixels.data(), count, imgui_color(rgb, alpha));
    list.Flags = flags;
  }
  void frustum_lines(const Frustum& corners, std::uint32_t rgb, float width_px) const {
    for (int k = 1; k <= 4; ++k) line(corners[0], corners[k], rgb, width_px);
    closed(std::span(corners).subspan(1, 4), rgb, width_px);
  }
};

void draw_true_camera(const SceneOverlay& overlay) {
  const Inspection& inspection = overlay.inspection();
  const std::map<int, Pose> cameras = true_cameras(inspection);
  const auto camera = cameras.find(overlay.view.in_window());
  if (camera == cameras.end()) return;
  const double depth = 0.75 * frustum_depth(inspection);
  const Frustum corners = frustum(inspection.recording->camera, camera->second, depth);
  overlay.frustum_lines(corners, color_of(Role::truth), 2);
}

void draw_uncertainty(const SceneOverlay& overlay) {
  const Initialization& estimate = *overlay.inspection().initialization;
  const auto& covariances = estimate.uncertainty->center_covariances;
  const int frame = overlay.view.in_window();
  if (frame == 0 || frame >= std::ssize(covariances)) return;
  for (const auto& line : confidence_ellipsoid(
           estimate.cameras[frame].p_wc, covariances[frame], overlay.view.options.show.uncertainty))
    overlay.closed(line, color_of(Role::uncertain), 1.2F);
}

/// Draws the items of a single frame over the rendered scene, so that a step renders nothing.
void draw_frame(const SceneOverlay& overlay) {
  const FrameView& view = overlay.view;
  const Inspection& inspection = view.inspection;
  const Initialization& estimate = *inspection.initialization;
  if (!view.inside()) return;
  const int frame = view.in_window();
  if (!estimate.ok || frame >= std::ssize(estimate.cameras)) {
    if (view.options.show.truth) draw_true_camera(overlay);
    return;
  }
  const std::uint32_t method = inspection.settings.options.method.row().rgb;
  const std::uint32_t rgb =
      frame == 0 ? color_of(Role::reference) : mixed_rgb(method, color_of(Role::text), 0.35);
  const Frustum corners =
      frustum(inspection.recording->camera, estimate.cameras[frame], frustum_depth(inspection));
  const std::array<Vector3d, 3> mark = {corners[1], corners[2], corners[5]};
  // Faces first: they would hide the lines behind them.
  overlay.face(std::span(corners).subspan(1, 4), rgb, 0.2);
  overlay.face(mark, rgb, 0.4);
  if (view.options.show.truth) draw_true_camera(overlay);
  if (shows_uncertainty(inspection, view.options)) draw_uncertainty(overlay);
  overlay.frustum_lines(corners, rgb, 2.6F);
  overlay.closed(mark, rgb, 2.6F);
}

/// Returns the cameras located after the window that is shown; null if there are none.
const Extrapolation* cameras_after(const FrameView& view) {
  const Extrapolation* after = view.options.after.get();
  const bool shown = after != nullptr && !after->cameras.empty() &&
                     after->inspection->window == view.inspection.window;
  return shown ? after : nullptr;
}

/// Draws their path in dashes, and the one of the current frame.
void draw_after(const SceneOverlay& overlay) {
  const FrameView& view = overlay.view;
  const Extrapolation* after = cameras_after(view);
  if (after == nullptr) return;
  const float s = overlay_scale();
  std::vector<Vector2d> path;
  const auto add = [&](const Pose& pose) {
    if (const auto pixel = overlay.at(pose.p_wc)) path.push_back(*pixel);
  };
  add(view.inspection.initialization->cameras.back());
  for (const ExtrapolatedCamera& camera : after->cameras) add(camera.pose);
  const std::array pattern = {5.0 * s, 4.0 * s};
  for (const auto& [from, to] : dashes_along(path, pattern))
    overlay.list.AddLine(to_imgui(from), to_imgui(to), imgui_color(Role::uncertain), 1.6F * s);
  const auto current = std::ranges::find(after->cameras, view.frame, &ExtrapolatedCamera::frame);
  if (current == after->cameras.end()) return;
  const Inspection& inspection = view.inspection;
  overlay.frustum_lines(
      frustum(inspection.recording->camera, current->pose, frustum_depth(inspection)),
      color_of(Role::uncertain),
      1.6F);
}

void draw_axes(const SceneOverlay& overlay) {
  constexpr std::array kAxes = {Role::axis_x, Role::axis_y, Role::axis_z};
  const float s = overlay_scale();
  const auto origin = overlay.at(Vector3d::Zero());
  for (int axis = 0; axis < 3 && origin; ++axis) {
    const auto tip = overlay.at(axes_length(overlay.inspection()) * Vector3d::Unit(axis));
    if (!tip) continue;
    const std::uint32_t rgb = color_of(kAxes[axis]);
    overlay.list.AddLine(to_imgui(*origin), to_imgui(*tip), imgui_color(rgb), 2.4F * s);
    const Vector2d step = *tip - *origin;
    const Vector2d along = step.norm() > 1 ? Vector2d(step.normalized()) : Vector2d(0, 0);
    write_label(overlay.list, Font::bold, *tip + 9 * s * along, std::string(1, "xyz"[axis]), rgb);
  }
}

bool shows_up(const FrameView& view) {
  return view.options.show.gravity && view.inspection.inertial && view.inspection.inertial->ok;
}

void draw_up(const SceneOverlay& overlay) {
  const Inspection& inspection = overlay.inspection();
  const Vector3d up = -inspection.inertial->gravity_m_s2.normalized();
  const auto from = overlay.at(Vector3d::Zero());
  const auto tip = overlay.at(1.6 * axes_length(inspection) * up);
  if (!from || !tip || (*tip - *from).norm() < 1) return;
  const float s = overlay_scale();
  const Vector2d along = (*tip - *from).normalized(), across(-along.y(), along.x());
  const Vector2d neck = *tip - 9 * s * along;
  const ImU32 color = imgui_color(Role::gravity);
  overlay.list.AddLine(to_imgui(*from), to_imgui(neck), color, 2 * s);
  overlay.list.AddTriangleFilled(
      to_imgui(*tip), to_imgui(neck + 4.5 * s * across), to_imgui(neck - 4.5 * s * across), color);
  write_label(overlay.list, Font::bold, *tip + 11 * s * along, "up", color_of(Role::gravity));
}

std::string bar_text(double length, bool meters) {
  if (!meters) return fmt::format("{:g} d", length);
  if (length < 0.01) return fmt::format("{:g} mm", length * 1e3);
  if (length < 1) return fmt::format("{:g} cm", length * 1e2);
  return fmt::format("{:g} m", length);
}

LegendRows legend_rows(const FrameView& view) {
  const auto& [inspection, frame, options] = view;
  const Method& method = inspection.settings.options.method.row();
  const bool ok = inspection.initialization->ok;
  LegendRows rows;
  const auto add = [&rows](Sign sign, std::uint32_t rgb, const std::string& text) {
    rows.push_back({sign, rgb, text});
  };
  if (ok) {
    const double side = cube_side(inspection, options.cube_side);
    const auto meters = shown_scale(inspection), scale = known_scale(inspection);
    const double cell = meters.value_or(1) * plane_grid(inspection, side).cell;
    const std::string cells = bar_text(cell, meters.has_value());
    const std::string length = scale ? ", " + length_text(*scale * side) : "";
    const auto points = inspection.initialization->points.size();
    const Sign point = options.colors ? Sign::none : Sign::dot;
    add(Sign::frustum, method.rgb, method.title + " cameras");
    if (view.in_window() > 0) add(Sign::frustum, color_of(Role::reference), "reference frame");
    add(Sign::square, color_of(Role::plane), "estimated plane, cells of " + cells);
    add(point, color_of(Role::map_point), fmt::format("{} map points", points));
    if (options.colors)
      for (const LegendRow& row : legend_rows(*options.colors)) rows.push_back(row);
    if (options.show.cube && inspection.cube)
      add(Sign::square,
          cube_color({}, *inspection.window),
          (inspection.other_cubes.empty() ? "cube" : "cubes on all planes") + length);
    if (const Extrapolation* after = cameras_after(view))
      add(Sign::line,
          color_of(Role::uncertain),
          counted(after->cameras.size(), "extrapolated camera") + ", dashed");
    if (shows_up(view)) {
      const double sigma_deg = inspection.inertial->gravity_sigma_deg;
      add(Sign::line,
          color_of(Role::gravity),
          sigma_deg <= 90 ? "up, uncertainty " + angle_text(sigma_deg) : "up, undetermined");
    }
  }
  if (inspection.initialization->refused)
    add(Sign::frustum, color_of(Role::bad), "rejected solution of " + method.title);
  if (shows_uncertainty(inspection, options)) {
    const int times = options.show.uncertainty;
    const std::string enlarged = times > 1 ? fmt::format(", enlarged {}\u00d7", times) : "";
    add(Sign::circle, color_of(Role::uncertain), "95 % of centers and normal" + enlarged);
  }
  if (options.show.truth && estimate_from_truth(inspection)) {
    const bool plane = ok && inspection.truth->plane.has_value();
    add(Sign::frustum, color_of(Role::truth), plane ? "true cameras and plane" : "true cameras");
  }
  return rows;
}

/// Draws a scale bar that is right at the depth of the view's target.
void draw_scale_bar(const SceneOverlay& overlay) {
  const auto meters = shown_scale(overlay.inspection());
  const float s = overlay_scale();
  const Vector2d size = overlay.rect.size;
  const double pixels = pixels_per_unit(overlay.camera, size.y()) / meters.value_or(1);
  const double length = nice_length(140 * s / pixels);
  const auto width = static_cast<float>(length * pixels);
  const ImVec2 end = to_imgui(overlay.rect.min + Vector2d(size.x() - 16 * s, 36 * s));
  const ImU32 color = imgui_color(Role::text);
  const ImVec2 start(end.x - width, end.y);
  overlay.list.AddLine(start, end, color, 2 * s);
  for (const float x : {start.x, end.x})
    overlay.list.AddLine(ImVec2(x, end.y - 5 * s), ImVec2(x, end.y + s), color, 2 * s);
  const std::string text = bar_text(length, meters.has_value());
  const double half = text_width(Font::small, text) / 2;
  const Vector2d at(end.x - width / 2 - half, end.y - font(Font::small)->FontSize - 7 * s);
  write_text(overlay.list, Font::small, at, text);
}

}  // namespace

bool shows_uncertainty(const Inspection& inspection, const ViewOptions& options) {
  return options.show.uncertainty > 0 && inspection.initialization->ok &&
         inspection.initialization->uncertainty.has_value();
}

void draw_scene_view(const Area& area,
                     const FrameView& view,
                     SceneView& scene,
                     const OrbitCamera& camera) {
  const auto& [list, rect] = area;
  const Inspection& inspection = view.inspection;
  const cv::Size size(static_cast<int>(rect.size.x()), static_cast<int>(rect.size.y()));
  const unsigned texture = scene.render(inspection, view.options, camera, size);
  if (texture == 0) return;
  area.clip();
  mark_content(list, scene.renders());
  list.AddImage(imgui_texture(texture), area.low(), area.high(), ImVec2(0, 1), ImVec2(1, 0));
  const SceneOverlay overlay{area, view, camera};
  draw_frame(overlay);
  draw_after(overlay);
  const bool shows_cameras =
      !found_cameras(*inspection.initialization).empty() || estimate_from_truth(inspection);
  if (shows_cameras) draw_axes(overlay);
  if (shows_up(view)) draw_up(overlay);
  if (view.options.show.legend) draw_legend_strip(area, legend_rows(view));
  if (shows_cameras) draw_scale_bar(overlay);
  if (!inspection.initialization->ok && view.options.says_failure) {
    const Vector2d legend(0, view.options.show.legend ? 20 * overlay_scale() : 0);
    const std::string& why = inspection.initialization->reason;
    draw_badge(
        {list, {rect.min, rect.size - legend}}, color_of(Role::warning), "not initialized", why);
  }
  list.PopClipRect();
}

}  // namespace gpo
