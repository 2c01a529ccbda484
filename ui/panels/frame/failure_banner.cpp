// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Says once why the window has no result, with buttons for ways out.
#include "ui/panels/panels.h"

namespace gpo {
namespace {

void action_button(const PanelContext& ui, const char* name) {
  const Action& action = action_named(name);
  if (ImGui::SmallButton(action.title.c_str())) push(ui.commands, RunAction{action.name});
  tooltip(action.tooltip);
  ImGui::SameLine(0, 6 * ui.scale);
}

void method_button(const PanelContext& ui) {
  if (ImGui::SmallButton("Another method")) ImGui::OpenPopup("methods");
  tooltip("Initializes the same window by another method");
  if (!ImGui::BeginPopup("methods")) return;
  for (const MethodChoice& method : ui.state.methods.all()) {
    const bool now = method == ui.state.document.settings.options.method;
    if (ImGui::MenuItem(method.row().title.c_str(), nullptr, now))
      push(ui.commands, RunAction{"method " + method.key()});
    tooltip(method.row().help);
  }
  ImGui::EndPopup();
}

}  // namespace

bool has_failed(const PanelInput& input) {
  const Inspection* inspection = input.inspection();
  return input.state.document.recording && inspection != nullptr && inspection->initialization &&
         !inspection->initialization->ok;
}

void failure_banner(const PanelContext& ui, const Rectangle& place) {
  const float s = ui.scale;
  ImGui::PushStyleColor(ImGuiCol_WindowBg,
                        imgui_color(mixed_rgb(color_of(Role::raised), color_of(Role::bad), 0.18)));
  {
    const float padding = std::round((place.height - ImGui::GetTextLineHeight()) / 2);
    const PanelScope scope("banner", place, {12 * s, padding});
    const Recording& recording = *ui.state.document.recording;
    const bool guessed = recording.camera_source == CameraSource::guess && recording.images;
    const bool another_start = ui.state.frame_count() > ui.state.document.settings.frames;
    float buttons = 150 * s + (another_start ? 110 * s : 0) + (guessed ? 190 * s : 0);
    const std::string why = "Not initialized: " + ui.inspection()->initialization->reason;
    const float room = std::max(60 * s, place.width - 24 * s - buttons);
    clipped_text(why, room, color_of(Role::text));
    ImGui::SameLine(0, 12 * s);
    ImGui::PushStyleColor(ImGuiCol_Button, imgui_color(Role::active));
    if (another_start) action_button(ui, "find-start");
    if (guessed) action_button(ui, "calibrate");
    method_button(ui);
    ImGui::PopStyleColor();
  }
  ImGui::PopStyleColor();
}

}  // namespace gpo
