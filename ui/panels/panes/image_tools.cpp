// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panes/image_tools.h"

#include "engine/inspection/studies/studies.h"
#include "ui/views/image/image_geometry.h"

namespace gpo {
namespace {

/// The pressed cube, kept by ImGui while the mouse is down.
struct KeptPress {
  ImGuiStorage& kept = *ImGui::GetStateStorage();
  ImGuiID number = ImGui::GetID("pressed cube"), dragged = ImGui::GetID("dragged");
  ImGuiID x = ImGui::GetID("center x"), y = ImGui::GetID("center y");
};

/// Remembers which cube was pressed, and how far from the center of its base [raw px].
void press(const PanelContext& ui, int frame, const Vector2d& raw_px) {
  const KeptPress press;
  press.kept.SetInt(press.number, 0);
  press.kept.SetBool(press.dragged, false);
  const ImGuiIO& io = ImGui::GetIO();
  const WorkbenchState& state = ui.state;
  const Inspection& inspection = *ui.inspection();
  if (!io.MouseDown[ImGuiMouseButton_Left] || io.KeyShift || io.KeyAlt) return;
  if (!state.view.toggles.cube) return;
  const CubeSize size{cube_side(inspection, state.document.cube_side)};
  const auto cube = cube_at(inspection, frame, size, raw_px);
  if (!cube) return;
  const Vector3d center =
      to_camera(inspection.initialization->cameras[frame], base_center(inspection, *cube));
  const Vector2d from = project(inspection.recording->camera, center) - raw_px;
  press.kept.SetInt(press.number, cube->plane.value_or(inspection.window->leader) + 1);
  press.kept.SetFloat(press.x, static_cast<float>(from.x()));
  press.kept.SetFloat(press.y, static_cast<float>(from.y()));
}

}  // namespace

bool drag_cube(const PanelContext& ui, int frame, const ImageMapping& mapping) {
  const Inspection* inspection = ui.inspection();
  if (!ImGui::IsItemActive() || inspection == nullptr || !inspection->initialization->ok)
    return false;
  const int in_window = frame - inspection->window->start;
  if (in_window < 0 || in_window >= inspection->window->frame_count()) return false;
  const Vector2d raw_px = to_image(mapping, mouse_px());
  if (ImGui::IsItemActivated()) press(ui, in_window, raw_px);
  const KeptPress press;
  const int number = press.kept.GetInt(press.number) - 1;
  if (number < 0) return false;
  const bool dragged = press.kept.GetBool(press.dragged);
  const Plane* plane = estimated_plane(*inspection, number);
  if (plane == nullptr || drag_px().isZero() || (!dragged && is_click(ui.scale))) return true;
  const Vector2d center(press.kept.GetFloat(press.x), press.kept.GetFloat(press.y));
  const auto point = point_on_plane(*inspection, in_window, raw_px + center, *plane);
  if (!point) return true;
  const bool leads = number == inspection->window->leader;
  push(ui.commands, MoveCube{*point, leads ? 0 : number + 1, dragged});
  press.kept.SetBool(press.dragged, true);
  return true;
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
