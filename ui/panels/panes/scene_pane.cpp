// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/views/image/image_view.h"
#include "ui/views/image/track_highlight.h"
#include "ui/views/scene/scene_geometry.h"

#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Vector2d;

void orbit_and_zoom(const OrbitCamera& camera, double height, Commands& commands) {
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemHovered() && io.MouseWheel != 0)
    push(commands, OrbitScene{zoomed(camera, io.MouseWheel)});
  if (is_item_double_clicked()) return push(commands, FitScene{});
  const Vector2d drag = drag_px();
  if (drag.isZero()) return;
  const bool move = io.KeyShift || ImGui::IsMouseDown(ImGuiMouseButton_Middle);
  push(commands, OrbitScene{move ? panned(camera, drag, height) : orbited(camera, drag, height)});
}

/// Returns what is under the mouse; a point has priority over a camera.
Hover hover_in(const PanelContext& ui, const ScreenRect& rect, const OrbitCamera& camera) {
  Hover hover;
  if (!ImGui::IsItemHovered()) return hover;
  const Inspection& inspection = *ui.inspection();
  const Vector2d at = mouse_px() - rect.min;
  if (const auto column = point_at(inspection, camera, rect.size, at, 7 * ui.scale))
    hover.track = inspection.tracks->ids[*column];
  else if (const auto frame = camera_at(inspection, camera, rect.size, at, 9 * ui.scale))
    hover.camera = inspection.window->start + *frame;
  return hover;
}

/// A right click moves the cube; a left one happens by mistake too easily.
void move_cube_to(const PanelContext& ui, const ScreenRect& rect, const OrbitCamera& camera) {
  if (!ImGui::IsItemHovered() || !ImGui::IsMouseReleased(ImGuiMouseButton_Right)) return;
  if (!is_click(ui.scale, ImGuiMouseButton_Right)) return;
  const auto point = plane_at(*ui.inspection(), camera, rect.size, mouse_px() - rect.min);
  if (point) push(ui.commands, MoveCube{*point});
}

/// A click selects the point, or goes to the camera's frame.
void click(const PanelContext& ui, const Hover& hover) {
  if (!ImGui::IsItemDeactivated() || !ImGui::IsMouseReleased(ImGuiMouseButton_Left)) return;
  if (!is_click(ui.scale)) return;
  if (hover.track)
    click_track(ui, *hover.track);
  else if (hover.camera)
    push(ui.commands, GoToFrame{*hover.camera});
}

/// `frame` counts in the recording.
void camera_tooltip(const Inspection& inspection, int frame) {
  const int in_window = frame - inspection.window->start;
  const Eigen::Vector3d& center = inspection.initialization->cameras[in_window].p_wc;
  show_tooltip(
      fmt::format("camera of frame {}\ncenter ({:.3f}, {:.3f}, {:.3f}) d\n{} inliers\n"
                  "Click goes to the frame",
                  frame,
                  center.x(),
                  center.y(),
                  center.z(),
                  inspection.window->inlier_count(in_window)));
}

}  // namespace

void scene_pane(const PanelContext& ui, const Rectangle& place) {
  if (!ui.inspection()) return draw_empty(place, "The scene appears when the window is computed");
  const WorkbenchState& state = ui.state;
  const Inspection& inspection = *ui.inspection();
  hit_area("view",
           {place.width, place.height},
           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle);
  const double side = cube_side(inspection, state.document.cube_side);
  const OrbitCamera camera = state.view.orbit.value_or(scene_camera(
      inspection, side, place.width / place.height, state.view.viewpoint, state.view.frame));
  const ScreenRect rect = screen_rect(place);
  orbit_and_zoom(camera, place.height, ui.commands);
  const Hover hover = hover_in(ui, rect, camera);
  if (ImGui::IsItemHovered() && hover != state.hover) push(ui.commands, HoverOver{hover});
  click(ui, hover);
  move_cube_to(ui, rect, camera);
  ViewOptions options = view_options(state, ui.views);
  options.show.legend &= has_room_for_legend(place, ui.scale);
  options.moving = ImGui::IsItemActive() && ImGui::IsMouseDragging(0, 0);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  draw_scene_view(list, rect, ui.views.scene, inspection, state.view.frame, camera, options);
  draw_highlight_in_scene(list,
                          rect,
                          inspection,
                          state.view.frame - inspection.window->start,
                          camera,
                          highlight_of(state));
  if (hover.track) track_tooltip(ui, *hover.track);
  if (hover.camera) camera_tooltip(inspection, *hover.camera);
}

}  // namespace gpo
