// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"

#include <algorithm>
#include <cmath>

namespace gpo {
namespace {

void centered(const char* text, const Rectangle& place) {
  const float width = ImGui::CalcTextSize(text).x;
  ImGui::SetCursorPosX(std::round((place.width - width) / 2));
  ImGui::TextUnformatted(text);
}

}  // namespace

namespace {

/// Centered, as wide as its text, in the color of what is to be done.
bool button(const char* title, const Rectangle& place, float scale, bool first) {
  const float width = std::max(220 * scale, ImGui::CalcTextSize(title).x + 32 * scale);
  ImGui::SetCursorPosX(std::round((place.width - width) / 2));
  if (first) ImGui::PushStyleColor(ImGuiCol_Button, imgui_color(Role::active));
  const bool clicked = ImGui::Button(title, {width, 32 * scale});
  if (first) ImGui::PopStyleColor();
  return clicked;
}

void recent_list(const PanelInput& input, const Rectangle& place, Commands& commands) {
  constexpr std::size_t kMost = 6;
  const std::vector<std::filesystem::path>& recent = input.state.files.recent;
  if (recent.empty()) return;
  ImGui::Dummy({1, 8 * input.scale});
  ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(Role::text_dim));
  centered("Opened before", place);
  ImGui::PopStyleColor();
  for (std::size_t i = 0; i < std::min(kMost, recent.size()); ++i) {
    const std::string name = recent[i].filename().string();
    const float width = ImGui::CalcTextSize(name.c_str()).x;
    ImGui::SetCursorPosX(std::round((place.width - width) / 2));
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Selectable(name.c_str(), false, 0, {width, 0})) push(commands, OpenPath{recent[i]});
    ImGui::PopID();
    tooltip(recent[i].string());
  }
}

}  // namespace

void empty_panel(const PanelInput& input, const Rectangle& place, Commands& commands) {
  const float s = input.scale;
  const PanelScope panel("empty", place, {0, 0});
  const float inset = std::round(24 * s);
  ImGui::GetWindowDrawList()->AddRect({place.x + inset, place.y + inset},
                                      {place.right() - inset, place.bottom() - inset},
                                      imgui_color(Role::border),
                                      8 * s,
                                      0,
                                      2 * s);
  ImGui::SetCursorPosY(std::round(place.height / 2 - 110 * s));
  if (input.worker.busy) {
    ImGui::PushFont(font(Font::heading));
    centered("Opening the recording ...", place);
    ImGui::PopFont();
    return;
  }
  ImGui::PushFont(font(Font::heading));
  centered("Drop a recording here", place);
  ImGui::PopFont();
  ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(Role::text_dim));
  centered("a video, a folder of images, a ROS bag, an EuRoC folder,", place);
  centered("tracks.csv with a calibration; a saved session; a results.csv", place);
  ImGui::PopStyleColor();
  ImGui::Dummy({1, 8 * s});
  if (button("Open ...", place, s, true)) push(commands, RunAction{"browse"});
  if (button("Open the example", place, s, false)) push(commands, RunAction{"open-example"});
  if (input.state.files.has_last_session && button("Continue the last session", place, s, false))
    push(commands, RunAction{"continue"});
  recent_list(input, place, commands);
}

}  // namespace gpo
