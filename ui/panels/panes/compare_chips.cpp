// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panes/compare_chips.h"

#include "engine/experiment/configuration.h"
#include "engine/initialize/method_defaults.h"
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/widgets.h"
#include "ui/workbench/compared.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr float kHeight = 24, kGap = 6;  // of a chip, at scale 1 [px]

/// Puts the next chip of this width beside the last one, or below it where there is no room.
void place_next(float& x, float& y, float width, const Rectangle& place, float s) {
  if (x > place.x + kGap * s && x + width > place.right() - kGap * s) {
    x = place.x + kGap * s;
    y += (kHeight + kGap) * s;
  }
  ImGui::SetCursorScreenPos({std::round(x), std::round(y)});
  x += width + kGap * s;
}

/// Whether its x was clicked.
bool draw_cross(const std::string& key, const ImVec2& at, float side, bool dim) {
  ImGui::SetCursorScreenPos(at);
  const bool clicked = hit_area(("remove " + key).c_str(), {side, side});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool hovered = ImGui::IsItemHovered() && !dim;
  const ImU32 color = imgui_color(hovered ? Role::text : Role::text_dim, dim ? 0.35 : 1);
  const ImVec2 middle(at.x + side / 2, at.y + side / 2);
  const float arm = side * 0.17F;
  list.AddLine({middle.x - arm, middle.y - arm}, {middle.x + arm, middle.y + arm}, color, 1.5F);
  list.AddLine({middle.x - arm, middle.y + arm}, {middle.x + arm, middle.y - arm}, color, 1.5F);
  tooltip(dim ? "The last one stays" : "Removes it from the comparison");
  return clicked;
}

/// `key`: as it is among the compared ones; `one`: what it comes to in the window.
void chip(const std::string& key,
          const Configuration& one,
          bool last,
          float width,
          float s,
          Commands& commands) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = std::round(kHeight * s);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float round = 4 * s;
  list.AddRectFilled(at, {at.x + width, at.y + height}, imgui_color(Role::raised), round);
  list.AddRectFilled(at,
                     {at.x + std::round(5 * s), at.y + height},
                     imgui_color(color_of(one)),
                     round,
                     ImDrawFlags_RoundCornersLeft);
  list.AddText(
      {at.x + std::round(12 * s), std::round(at.y + (height - ImGui::GetTextLineHeight()) / 2)},
      imgui_color(Role::text),
      title_of(one).c_str());
  const bool remove = draw_cross(key, {at.x + width - height, at.y}, height, last);
  if (remove && !last) push(commands, RunAction{"compare remove " + key});
}

/// The current settings, as they are or with the other RANSAC, beside what is compared.
Configuration current(const WorkbenchState& state, std::optional<bool> ransac) {
  Settings settings = state.settings;
  if (ransac) settings.options.ransac = ransac;
  return called_among_compared(state, settings);
}

void entry(const PanelInput& input,
           const Configuration& one,
           const std::string& title,
           Commands& commands) {
  const std::string key = key_of(one);
  const bool there = std::ranges::find(input.state.compared, key) != input.state.compared.end();
  const float side = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + side * 0.15F},
                                            {at.x + side * 0.35F, at.y + side * 0.85F},
                                            imgui_color(color_of(one)),
                                            side * 0.1F);
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + side * 0.7F);
  if (ImGui::MenuItem(fmt::format("{}##{}", title, title + key).c_str(), nullptr, there))
    push(commands, RunAction{(there ? "compare remove " : "compare add ") + key});
}

void list_of_all(const PanelInput& input, Commands& commands) {
  if (!ImGui::BeginPopup("add")) return;
  heading("CURRENT SETTINGS");
  const WorkbenchState& state = input.state;
  const Configuration now = current(state, {});
  entry(input, now, title_of(configuration_of(state.settings)), commands);
  const bool ransac = uses_ransac(state.settings.options);
  entry(input,
        current(state, !ransac),
        fmt::format("the same {} RANSAC", ransac ? "without" : "with"),
        commands);
  ImGui::Separator();
  heading("METHODS AND ABLATIONS");
  for (const Configuration& one : parse_configurations("all", state.methods))
    entry(input, one, title_of(one), commands);
  ImGui::Separator();
  if (ImGui::MenuItem("The paper's four")) push(commands, RunAction{"compare paper"});
  if (ImGui::MenuItem("All of them")) push(commands, RunAction{"compare all"});
  ImGui::EndPopup();
}

}  // namespace

float compare_chips(const PanelInput& input, const Rectangle& place, Commands& commands) {
  const float s = input.scale;
  const auto& keys = input.state.compared;
  float x = place.x + kGap * s, y = place.y + kGap * s;
  const std::vector<Settings> settings = compared_settings(input.state, input.state.settings);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Configuration one = called_among_compared(input.state, settings[i]);
    const float width =
        std::round(ImGui::CalcTextSize(title_of(one).c_str()).x + (12 + kHeight) * s);
    place_next(x, y, width, place, s);
    chip(keys[i], one, keys.size() == 1, width, s, commands);
  }
  const float side = std::round(kHeight * s);
  place_next(x, y, side, place, s);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, 0});
  if (ImGui::Button("+", {side, side})) ImGui::OpenPopup("add");
  ImGui::PopStyleVar();
  tooltip("Compare also: every method, and the current settings with and without RANSAC");
  list_of_all(input, commands);
  return std::round(y + (kHeight + kGap) * s - place.y);
}

}  // namespace gpo
