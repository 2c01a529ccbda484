// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/panels/panels.h"
#include "ui/panels/panes/view_options.h"
#include "ui/panels/track_tooltip.h"
#include "ui/panels/widgets.h"
#include "ui/views/image/image_view.h"
#include "ui/views/image/pointing.h"
#include "ui/views/scene/scene_geometry.h"

namespace gpo {
namespace {

using Eigen::Vector2d;

void orbit_and_zoom(const OrbitCamera& camera, double height, Commands& commands) {
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
    push(commands, OrbitScene{zoomed(camera, io.MouseWheel)});
  }
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) {
    push(commands, FitScene{});
    return;
  }
  const Vector2d by(io.MouseDelta.x, io.MouseDelta.y);
  if (!ImGui::IsItemActive() || by.isZero()) return;
  const bool move = io.KeyShift || ImGui::IsMouseDown(2);
  push(commands, OrbitScene{move ? panned(camera, by, height) : orbited(camera, by, height)});
}

/// What the mouse is over; a point before a camera.
Hover hover_in(const Inspection& inspection,
               const ScreenRect& rect,
               const OrbitCamera& camera,
               float scale) {
  Hover hover;
  if (!ImGui::IsItemHovered()) return hover;
  const Vector2d at = Vector2d(ImGui::GetIO().MousePos.x, ImGui::GetIO().MousePos.y) - rect.min;
  const ScenePixel pixel{camera, rect.size, at};
  if (const auto column = point_at(inspection, pixel, 7 * scale)) {
    hover.track = inspection.tracks->ids[*column];
  } else if (const auto frame = camera_at(inspection, pixel, 9 * scale)) {
    hover.camera = inspection.window->start + *frame;
  }
  return hover;
}

/// Right click: moves the cube to there on the plane; a left one is too easily astray.
void move_cube_to(const PanelInput& input,
                  const ScreenRect& rect,
                  const OrbitCamera& camera,
                  Commands& commands) {
  const ImGuiIO& io = ImGui::GetIO();
  const Vector2d at(io.MousePos.x, io.MousePos.y);
  const Vector2d pressed(io.MouseClickedPos[1].x, io.MouseClickedPos[1].y);
  if (!ImGui::IsItemHovered() || !ImGui::IsMouseReleased(1)) return;
  if ((at - pressed).norm() > 4 * input.scale) return;
  const auto point = plane_at(*input.inspection(), {camera, rect.size, at - rect.min});
  if (point) push(commands, MoveCube{*point});
}

/// Click: picks the point, or goes to the camera's frame.
void click(const PanelInput& input, const Hover& hover, Commands& commands) {
  const ImGuiIO& io = ImGui::GetIO();
  const Vector2d at(io.MousePos.x, io.MousePos.y);
  const Vector2d pressed(io.MouseClickedPos[0].x, io.MouseClickedPos[0].y);
  if (!ImGui::IsItemDeactivated() || !ImGui::IsMouseReleased(0)) return;
  if ((at - pressed).norm() > 4 * input.scale) return;
  const Selection& selection = input.state.selection;
  if (hover.track) {
    push(
        commands,
        SelectTracks{io.KeyCtrl ? toggled(selection, *hover.track) : selected({&*hover.track, 1})});
    if (!io.KeyCtrl) lead_with(input.state, *hover.track, commands);
  } else if (hover.camera) {
    push(commands, GoToFrame{*hover.camera});
  }
}

}  // namespace

void scene_pane(const PanelInput& input, const Rectangle& place, Views& views, Commands& commands) {
  if (!input.inspection())
    return draw_empty(place, "The scene appears when the window is computed");
  const WorkbenchState& state = input.state;
  const Inspection& inspection = *input.inspection();
  hit_area("view",
           {place.width, place.height},
           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle);
  const double side = cube_side(inspection, state.document.cube_side);
  const OrbitCamera camera = state.view.orbit.value_or(scene_camera(
      inspection, side, place.width / place.height, state.view.viewpoint, state.view.frame));
  const ScreenRect rect = screen_rect(place);
  orbit_and_zoom(camera, place.height, commands);
  const Hover hover = hover_in(inspection, rect, camera, input.scale);
  if (ImGui::IsItemHovered() && hover != state.hover) push(commands, HoverOver{hover});
  click(input, hover, commands);
  move_cube_to(input, rect, camera, commands);
  ViewOptions options = view_options(state, views);
  options.show.legend &= room_for_legend(place, input.scale);
  options.moving = ImGui::IsItemActive() && ImGui::IsMouseDragging(0, 0);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const FrameView view{inspection, state.view.frame, options};
  draw_scene_view(list, rect, view, views.scene, camera);
  draw_highlight_in_scene(list, rect, view, camera, highlight_of(state));
  if (hover.track) track_tooltip(input, views, *hover.track);
  if (hover.camera) camera_tooltip(input, *hover.camera);
}

}  // namespace gpo
