// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The line above the views: why the window has no result, or what a live source lacks.
#include "ui/panels/panels.h"
#include "ui/workbench/work/live_host.h"

namespace gpo {
namespace {

void banner(const PanelContext& ui, const Rectangle& place, Role role, auto&& draw) {
  const std::uint32_t rgb = mixed_rgb(color_of(Role::raised), color_of(role), 0.18);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_color(rgb));
  ImGui::PushStyleColor(ImGuiCol_Button, imgui_color(Role::active));
  {
    const float padding = std::round((place.height - ImGui::GetTextLineHeight()) / 2);
    const PanelScope scope("banner", place, {12 * ui.scale, padding});
    draw();
  }
  ImGui::PopStyleColor(2);
}

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

Role role_of_live(const LiveView& live) {
  if (!live.capture.message.empty()) return Role::warning;
  return live.answer && live.answer->missing.empty() ? Role::good : Role::accent;
}

}  // namespace

bool has_failed(const PanelInput& input) {
  const Inspection* inspection = input.inspection();
  return input.state.document.recording && inspection != nullptr && inspection->initialization &&
         !inspection->initialization->ok;
}

void failure_banner(const PanelContext& ui, const Rectangle& place) {
  banner(ui, place, Role::bad, [&] {
    const float s = ui.scale;
    const Recording& recording = *ui.state.document.recording;
    const bool guessed = recording.camera_source == CameraSource::guess && recording.images;
    const bool another_start = ui.state.frame_count() > ui.state.document.settings.frames;
    float buttons = 150 * s + (another_start ? 110 * s : 0) + (guessed ? 190 * s : 0);
    const std::string why = "Not initialized: " + ui.inspection()->initialization->reason;
    const float room = std::max(60 * s, place.width - 24 * s - buttons);
    clipped_text(why, room, color_of(Role::text));
    ImGui::SameLine(0, 12 * s);
    if (another_start) action_button(ui, "find-start");
    if (guessed) action_button(ui, "calibrate");
    method_button(ui);
  });
}

void live_banner(const PanelContext& ui, const Rectangle& place) {
  const LiveView& live = *ui.state.live;
  banner(ui, place, role_of_live(live), [&] {
    const float s = ui.scale;
    const std::string counts = counts_text(live);
    const float counts_width = ImGui::CalcTextSize(counts.c_str()).x;
    const float button_width = 76 * s;
    const float room = place.width - 24 * s - button_width - 12 * s;
    clipped_text("Live: " + progress_text(live),
                 std::max(60 * s, room - counts_width - 12 * s),
                 color_of(Role::text));
    if (room - counts_width > 160 * s) {
      ImGui::SameLine(12 * s + room - counts_width);
      colored_text(Role::text_dim, counts);
    }
    ImGui::SameLine(place.width - 12 * s - button_width);
    if (ImGui::SmallButton("Freeze")) push(ui.commands, RunAction{"freeze"});
    tooltip("Space. " + action_named("freeze").tooltip);
  });
}

}  // namespace gpo
