// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// An empty window with the ways to open a recording.
#include "ui/panels/panels.h"

#include <algorithm>

namespace gpo {
namespace {

void centered(const char* text,
              const Rectangle& place,
              Font which = Font::regular,
              Role role = Role::text_dim) {
  ImGui::PushFont(font(which));
  ImGui::SetCursorPosX(std::round((place.width - ImGui::CalcTextSize(text).x) / 2));
  colored_text(role, text);
  ImGui::PopFont();
}

bool centered_button(const char* title, const Rectangle& place, float scale, bool first = false) {
  const float width = std::max(220 * scale, ImGui::CalcTextSize(title).x + 32 * scale);
  ImGui::SetCursorPosX(std::round((place.width - width) / 2));
  if (first) ImGui::PushStyleColor(ImGuiCol_Button, imgui_color(Role::active));
  const bool clicked = ImGui::Button(title, {width, 32 * scale});
  if (first) ImGui::PopStyleColor();
  return clicked;
}

void recent_list(const PanelContext& ui, const Rectangle& place) {
  constexpr std::size_t kMost = 6;
  const std::vector<fs::path>& recent = ui.state.files.recent;
  if (recent.empty()) return;
  ImGui::Dummy({1, 8 * ui.scale});
  centered("Recent", place);
  const std::vector<std::string> names =
      short_names(std::span(recent).first(std::min(kMost, recent.size())));
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string& name = names[i];
    const float width = ImGui::CalcTextSize(name.c_str()).x;
    ImGui::SetCursorPosX(std::round((place.width - width) / 2));
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Selectable(name.c_str(), false, 0, {width, 0}))
      push(ui.commands, OpenPath{recent[i]});
    ImGui::PopID();
    tooltip(recent[i].string());
  }
}

}  // namespace

void empty_panel(const PanelContext& ui, const Rectangle& place) {
  const float s = ui.scale;
  const PanelScope scope("empty", place, {0, 0});
  const float inset = std::round(24 * s);
  const ImVec2 low(place.x + inset, place.y + inset);
  const ImVec2 high(place.right() - inset, place.bottom() - inset);
  ImGui::GetWindowDrawList()->AddRect(low, high, imgui_color(Role::border), 8 * s, 0, 2 * s);
  ImGui::SetCursorPosY(std::round(place.height / 2 - 110 * s));
  if (ui.worker.busy)
    return centered("Opening the recording ...", place, Font::heading, Role::text);
  centered("Drop a recording here", place, Font::heading, Role::text);
  centered("a video, a folder of images, a ROS bag, an EuRoC folder,", place);
  centered("tracks.csv with a calibration, a saved session, or a results.csv", place);
  ImGui::Dummy({1, 8 * s});
  if (centered_button("Open ...", place, s, true)) push(ui.commands, RunAction{"browse"});
  if (centered_button("Open the example", place, s)) push(ui.commands, RunAction{"open-example"});
  if (ui.state.files.has_last_session && centered_button("Continue the last session", place, s))
    push(ui.commands, RunAction{"continue"});
  if (ui.state.view.tour == 0 && centered_button("Take the tour", place, s))
    push(ui.commands, RunAction{"tour"});
  recent_list(ui, place);
}

}  // namespace gpo
