// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/error.h"
#include "ui/context/gui.h"
#include "ui/panels/panels.h"
#include "ui/panels/view_options.h"
#include "ui/panels/widgets.h"
#include "ui/views/image_view.h"
#include "ui/views/overlay.h"
#include "ui/views/palette.h"

#include <cmath>

namespace gpo {
namespace {

/// Brings the picture of the current frame into the texture, where it is not there yet.
void update_picture(const WorkbenchState& state, Views& views) {
  if (views.recording == state.recording && views.frame == state.frame) return;
  views.recording = state.recording;
  views.frame = state.frame;
  views.picture_error.clear();
  if (!state.recording->pictures) return;
  try {
    views.picture.upload(state.recording->pictures->bgr(state.frame));
  } catch (const InputError& error) {
    views.picture_error = error.what();
  }
}

void handle_mouse(const WorkbenchState& state, const ScreenRect& rect, Commands& commands) {
  const ImGuiIO& io = ImGui::GetIO();
  const Camera& camera = state.recording->camera;
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
    const Eigen::Vector2d pointer(io.MousePos.x, io.MousePos.y);
    const double by = std::pow(1.25, io.MouseWheel);
    push(commands, ZoomPicture{zoom_about(state.picture_zoom, camera, rect, pointer, by)});
  }
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) {
    push(commands, ZoomPicture{});
  } else if (ImGui::IsItemActive() && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
    const Eigen::Vector2d by(io.MouseDelta.x, io.MouseDelta.y);
    push(commands, ZoomPicture{pan(state.picture_zoom, camera, rect, by)});
  }
}

}  // namespace

void image_panel(const PanelInput& input,
                 const Rectangle& place,
                 Views& views,
                 Commands& commands) {
  ImGui::SetNextWindowBgAlpha(0);  // all of it is drawn over
  const PanelScope panel("picture", place, {0, 0});
  const WorkbenchState& state = input.state;
  update_picture(state, views);
  ImGui::InvisibleButton("view",
                         {place.width, place.height},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle);
  const ScreenRect rect = screen_rect(place);
  handle_mouse(state, rect, commands);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool shown = state.recording->pictures && views.picture_error.empty();
  const Inspection waiting = input.inspection ? Inspection{} : nothing_inspected(state.recording);
  ImageViewOptions options = image_options(state, input.inspection);
  options.legend = options.legend && room_for_legend(place, input.scale);
  draw_image_view(list,
                  rect,
                  input.inspection ? *input.inspection : waiting,
                  state.frame,
                  shown ? &views.picture : nullptr,
                  state.picture_zoom,
                  options);
  if (!views.picture_error.empty()) {
    draw_badge(list, rect, palette::kBad, "no picture", views.picture_error);
  }
}

}  // namespace gpo
