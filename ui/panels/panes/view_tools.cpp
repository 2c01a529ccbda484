// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/studies.h"
#include "ui/panels/panels.h"
#include "ui/views/image/image_geometry.h"

#include <array>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

/// A view in which the mouse drags cubes, with pixels of its own.
struct CubeView {
  std::function<std::optional<CubeAnchor>(const Vector2d& pixel)> cube_at;
  std::function<std::optional<Vector2d>(const Vector3d& point)> pixel_of;
  std::function<std::optional<Vector3d>(const Vector2d& pixel, const Plane& plane)> on_plane;
};

/// Returns which cube is pressed, and how far from the center of its base.
PressedCube pressed_at(const PanelContext& ui, const Vector2d& pixel, const CubeView& view) {
  const ImGuiIO& io = ImGui::GetIO();
  const Inspection& inspection = *ui.inspection();
  if (!io.MouseDown[ImGuiMouseButton_Left] || io.KeyShift || io.KeyAlt) return {};
  if (!ui.state.view.toggles.cube) return {};
  const auto cube = view.cube_at(pixel);
  const auto center = cube ? view.pixel_of(base_center(inspection, *cube)) : std::nullopt;
  if (!center) return {};
  return {cube->plane.value_or(inspection.window->leader), (*center - pixel).cast<float>()};
}

bool drag(const PanelContext& ui, const Vector2d& pixel, const CubeView& view) {
  PressedCube& pressed = ui.views.pressed;
  if (ImGui::IsItemActivated()) pressed = pressed_at(ui, pixel, view);
  if (!pressed.plane) return false;
  const Inspection& inspection = *ui.inspection();
  const Plane* plane = estimated_plane(inspection, *pressed.plane);
  if (plane == nullptr || drag_px().isZero() || (!pressed.dragged && is_click(ui.scale)))
    return true;
  const auto point = view.on_plane(pixel + pressed.center_px.cast<double>(), *plane);
  if (!point) return true;
  const bool leads = *pressed.plane == inspection.window->leader;
  push(ui.commands,
       [to = *point, number = leads ? 0 : *pressed.plane + 1, again = pressed.dragged](
           WorkbenchState& state) { move_cube(state, to, number, again); });
  pressed.dragged = true;
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

using DrawMask = SetView<std::optional<Mask>, &ViewState::drawn_mask>;

/// Returns the pixel under a place of the screen, within the image, in tenths.
Vector2d pixel_under(const Camera& camera, const ImageMapping& mapping, const Vector2d& at) {
  const Vector2d raw_px = to_image(mapping, at)
                              .cwiseMax(Vector2d(-0.5, -0.5))
                              .cwiseMin(Vector2d(camera.width - 0.5, camera.height - 0.5));
  return (10 * raw_px).array().round() / 10;
}

void finish(const PanelContext& ui, const Mask& mask) {
  std::vector<double> numbers;
  for (const Vector2d& corner : mask.corners_raw_px)
    numbers.insert(numbers.end(), {corner.x(), corner.y()});
  push(ui.commands,
       RunAction{fmt::format("mask {} {}", to_string(mask.kind), fmt::join(numbers, " "))});
}

/// A click at the first or at the last corner closes a polygon.
bool closes(const Mask& mask, const ImageMapping& mapping, const Vector2d& at, float scale) {
  const auto& corners = mask.corners_raw_px;
  if (corners.size() < 3) return false;
  const auto near = [&](const Vector2d& corner) {
    return (to_screen(mapping, corner) - at).norm() < 8 * scale;
  };
  return near(corners.front()) || near(corners.back());
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

bool takes_mask(const WorkbenchState& state, int frame) {
  return state.view.drawn_mask && frame == state.document.settings.start;
}

void draw_mask_by_mouse(const PanelContext& ui, const ImageMapping& mapping) {
  if (!ImGui::IsItemDeactivated() || !ImGui::IsMouseReleased(ImGuiMouseButton_Left)) return;
  const Camera& camera = shown_recording(ui.state)->camera;
  Mask mask = *ui.state.view.drawn_mask;
  const Vector2d at = mouse_px();
  const ImVec2& pressed = ImGui::GetIO().MouseClickedPos[ImGuiMouseButton_Left];
  if (!is_click(ui.scale) && mask.corners_raw_px.empty()) {
    mask.corners_raw_px = {pixel_under(camera, mapping, Vector2d(pressed.x, pressed.y)),
                           pixel_under(camera, mapping, at)};
    if (mask.area_px2() >= 1) finish(ui, mask);
  } else if (closes(mask, mapping, at, ui.scale)) {
    finish(ui, mask);
  } else {
    mask.corners_raw_px.push_back(pixel_under(camera, mapping, at));
    push(ui.commands, DrawMask{mask});
  }
}

void draw_unfinished_mask(const PanelContext& ui, const Area& area, const ImageMapping& mapping) {
  const Camera& camera = shown_recording(ui.state)->camera;
  Mask mask = *ui.state.view.drawn_mask;
  const ImageCanvas canvas{area, camera, mapping};
  const bool dragged = ImGui::IsItemActive() && !is_click(ui.scale) && mask.corners_raw_px.empty();
  if (dragged) {
    const ImVec2& pressed = ImGui::GetIO().MouseClickedPos[ImGuiMouseButton_Left];
    mask.corners_raw_px.push_back(pixel_under(camera, mapping, Vector2d(pressed.x, pressed.y)));
  }
  for (const Vector2d& corner : mask.corners_raw_px)
    draw_sign(area.list, Sign::square, canvas.at(corner), mask_color(mask.kind));
  if (!mask.corners_raw_px.empty() && ImGui::IsItemHovered())
    mask.corners_raw_px.push_back(pixel_under(camera, mapping, mouse_px()));
  // Two corners of an unfinished polygon are a line, those of a dragged rectangle its diagonal.
  const auto corners = mask.corners_raw_px.size();
  if (corners > 2 || (dragged && corners == 2))
    draw_mask(canvas, mask);
  else if (corners == 2)
    canvas.polyline(mask.corners_raw_px, imgui_color(mask_color(mask.kind)), 2);
  draw_badge(area,
             mask_color(mask.kind),
             mask.kind == MaskKind::plane ? "Area of the main plane" : "Area to leave out",
             "Drag a rectangle, or click the corners of a polygon and its first one again. Esc "
             "cancels.");
}

}  // namespace gpo
