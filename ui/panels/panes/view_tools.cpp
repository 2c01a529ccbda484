// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panes/view_tools.h"

#include "engine/inspection/studies/studies.h"
#include "ui/views/image/image_geometry.h"

#include <array>
#include <functional>

namespace gpo {
namespace {

/// A view in which the mouse drags cubes, with pixels of its own.
struct CubeView {
  std::function<std::optional<CubeAnchor>(const Vector2d& pixel)> cube_at;
  std::function<std::optional<Vector2d>(const Vector3d& point)> pixel_of;
  std::function<std::optional<Vector3d>(const Vector2d& pixel, const Plane& plane)> on_plane;
};

/// The pressed cube, kept by ImGui while the mouse is down.
struct KeptPress {
  ImGuiStorage& values = *ImGui::GetStateStorage();
  ImGuiID number = ImGui::GetID("pressed cube"), dragged = ImGui::GetID("dragged");
  ImGuiID x = ImGui::GetID("center x"), y = ImGui::GetID("center y");
};

/// Remembers which cube was pressed, and how far from the center of its base.
void press(const PanelContext& ui, const Vector2d& pixel, const CubeView& view) {
  const KeptPress kept;
  kept.values.SetInt(kept.number, 0);
  kept.values.SetBool(kept.dragged, false);
  const ImGuiIO& io = ImGui::GetIO();
  const Inspection& inspection = *ui.inspection();
  if (!io.MouseDown[ImGuiMouseButton_Left] || io.KeyShift || io.KeyAlt) return;
  if (!ui.state.view.toggles.cube) return;
  const auto cube = view.cube_at(pixel);
  const auto center = cube ? view.pixel_of(base_center(inspection, *cube)) : std::nullopt;
  if (!center) return;
  kept.values.SetInt(kept.number, cube->plane.value_or(inspection.window->leader) + 1);
  kept.values.SetFloat(kept.x, static_cast<float>(center->x() - pixel.x()));
  kept.values.SetFloat(kept.y, static_cast<float>(center->y() - pixel.y()));
}

bool drag(const PanelContext& ui, const Vector2d& pixel, const CubeView& view) {
  if (ImGui::IsItemActivated()) press(ui, pixel, view);
  const KeptPress kept;
  const Inspection& inspection = *ui.inspection();
  const int number = kept.values.GetInt(kept.number) - 1;
  if (number < 0) return false;
  const bool dragged = kept.values.GetBool(kept.dragged);
  const Plane* plane = estimated_plane(inspection, number);
  if (plane == nullptr || drag_px().isZero() || (!dragged && is_click(ui.scale))) return true;
  const Vector2d from(kept.values.GetFloat(kept.x), kept.values.GetFloat(kept.y));
  const auto point = view.on_plane(pixel + from, *plane);
  if (!point) return true;
  const bool leads = number == inspection.window->leader;
  push(ui.commands, MoveCube{*point, leads ? 0 : number + 1, dragged});
  kept.values.SetBool(kept.dragged, true);
  return true;
}

bool may_drag(const PanelContext& ui) {
  return ImGui::IsItemActive() && ui.inspection() != nullptr && ui.inspection()->initialization->ok;
}

bool drag_cube_in_scene(const PanelContext& ui, const ScreenRect& rect, const OrbitCamera& camera) {
  if (!may_drag(ui)) return false;
  const Inspection& inspection = *ui.inspection();
  const auto at = [&](const Vector2d& pixel) { return ScenePixel{camera, rect.size, pixel}; };
  const double side = cube_side(inspection, ui.state.document.cube_side);
  const CubeView view{
      [&](const Vector2d& pixel) { return cube_at(inspection, side, at(pixel)); },
      [&](const Vector3d& point) { return at(Vector2d::Zero()).pixel_of(point); },
      [&](const Vector2d& pixel, const Plane& plane) { return point_on_plane(plane, at(pixel)); }};
  return drag(ui, mouse_px() - rect.min, view);
}

}  // namespace

bool drag_cube(const PanelContext& ui, int frame, const ImageMapping& mapping) {
  if (!may_drag(ui)) return false;
  const Inspection& inspection = *ui.inspection();
  const int in_window = frame - inspection.window->start;
  if (in_window < 0 || in_window >= inspection.window->frame_count()) return false;
  const CubeSize size{cube_side(inspection, ui.state.document.cube_side)};
  const CubeView view{
      [&](const Vector2d& raw_px) { return cube_at(inspection, in_window, size, raw_px); },
      [&](const Vector3d& point) {
        const Pose& camera = inspection.initialization->cameras[in_window];
        return std::optional(project(inspection.recording->camera, to_camera(camera, point)));
      },
      [&](const Vector2d& raw_px, const Plane& plane) {
        return point_on_plane(inspection, in_window, raw_px, plane);
      }};
  return drag(ui, to_image(mapping, mouse_px()), view);
}

void orbit_and_zoom(const PanelContext& ui, const ScreenRect& rect, const OrbitCamera& camera) {
  Commands& commands = ui.commands;
  const double height = rect.size.y();
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemHovered() && io.MouseWheel != 0)
    push(commands, OrbitScene{zoomed(camera, io.MouseWheel)});
  if (is_item_double_clicked()) return push(commands, OrbitScene{});
  const Vector2d drag = drag_px();
  if (drag_cube_in_scene(ui, rect, camera)) {
    // A view that fits the cube would move with it.
    if (!is_click(ui.scale)) push(commands, OrbitScene{camera});
    return;
  }
  if (drag.isZero()) return;
  const bool move = io.KeyShift || ImGui::IsMouseDown(ImGuiMouseButton_Middle);
  push(commands, OrbitScene{move ? panned(camera, drag, height) : orbited(camera, drag, height)});
}

void draw_picked_points(const WorkbenchState& state,
                        const Area& area,
                        const FrameView& view,
                        const ImageMapping& mapping) {
  const Selection& selection = state.selection;
  if (selection.points_frame == view.frame) draw_points(area, view, mapping, selection.points_px);
  const Settings& settings = state.document.settings;
  const PointPair& scale = settings.scale_points;
  if (scale.empty() || scale.frame().value_or(settings.start) != view.frame) return;
  draw_points(area, view, mapping, std::array{scale.point(0), scale.point(1)});
}

}  // namespace gpo
