// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Draws masks with the mouse.
#include "ui/panels/panes/view_tools.h"
#include "ui/views/image/image_geometry.h"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

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

bool takes_mask(const WorkbenchState& state, int frame) {
  return state.view.drawn_mask && frame == state.document.settings.start;
}

void draw_mask_by_mouse(const PanelContext& ui, const ImageMapping& mapping) {
  if (!ImGui::IsItemDeactivated() || !ImGui::IsMouseReleased(ImGuiMouseButton_Left)) return;
  const Camera& camera = ui.state.document.recording->camera;
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
  const Camera& camera = ui.state.document.recording->camera;
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
