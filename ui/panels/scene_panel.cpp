// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/panels/panels.h"
#include "ui/panels/view_options.h"
#include "ui/panels/widgets.h"
#include "ui/views/image_view.h"
#include "ui/views/palette.h"
#include "ui/views/scene_geometry.h"

#include <cmath>

namespace gpo {
namespace {

void handle_mouse(const OrbitCamera& camera, double height, Commands& commands) {
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
    push(commands, OrbitScene{zoomed(camera, io.MouseWheel)});
  }
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) {
    push(commands, FitScene{});
    return;
  }
  const Eigen::Vector2d by(io.MouseDelta.x, io.MouseDelta.y);
  if (!ImGui::IsItemActive() || by.isZero()) return;
  const bool move = io.KeyShift || ImGui::IsMouseDown(2);
  push(commands, OrbitScene{move ? panned(camera, by, height) : orbited(camera, by, height)});
}

void draw_waiting(const Rectangle& place) {
  const char* text = "The scene appears when the window is computed";
  ImGui::GetWindowDrawList()->AddRectFilled(
      {place.x, place.y}, {place.right(), place.bottom()}, imgui_color(palette::kSceneBottom));
  const ImVec2 size = ImGui::CalcTextSize(text);
  ImGui::GetWindowDrawList()->AddText({std::round(place.x + (place.width - size.x) / 2),
                                       std::round(place.y + (place.height - size.y) / 2)},
                                      imgui_color(palette::kTextDim),
                                      text);
}

}  // namespace

void scene_panel(const PanelInput& input,
                 const Rectangle& place,
                 Views& views,
                 Commands& commands) {
  ImGui::SetNextWindowBgAlpha(0);  // all of it is drawn over
  const PanelScope panel("scene", place, {0, 0});
  if (!input.inspection) return draw_waiting(place);
  const WorkbenchState& state = input.state;
  const Inspection& inspection = *input.inspection;
  ImGui::InvisibleButton("view",
                         {place.width, place.height},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle);
  const double side = cube_side(inspection, state.cube_side);
  const OrbitCamera camera =
      state.orbit.value_or(default_scene_camera(inspection, side, place.width / place.height));
  handle_mouse(camera, place.height, commands);
  SceneViewOptions options = scene_options(state);
  options.legend = room_for_legend(place, input.scale);
  draw_scene_view(*ImGui::GetWindowDrawList(),
                  screen_rect(place),
                  views.scene,
                  inspection,
                  state.frame,
                  camera,
                  options);
}

}  // namespace gpo
