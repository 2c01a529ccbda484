// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/theme.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"

#include <array>

namespace gpo {
namespace {

constexpr std::array kAll = {
    Splitter::column, Splitter::settings, Splitter::image, Splitter::drawer};
constexpr float kGrip = 7;  // as wide as one can hit [px]

/// The line's surroundings, over whatever is there.
void begin(const char* name, const Rectangle& grip) {
  ImGui::SetNextWindowPos({grip.x, grip.y});
  ImGui::SetNextWindowSize({grip.width, grip.height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0F);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::Begin(name,
               nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PopStyleVar(3);
}

void splitter(Splitter which,
              const PanelInput& input,
              const WindowLayout& layout,
              Commands& commands) {
  const Rectangle line = place_of(which, layout, input.scale);
  if (line.empty()) return;
  const bool upright = line.height > line.width;
  const float out = std::round((kGrip * input.scale - (upright ? line.width : line.height)) / 2);
  const Rectangle grip = upright
                             ? Rectangle{line.x - out, line.y, line.width + 2 * out, line.height}
                             : Rectangle{line.x, line.y - out, line.width, line.height + 2 * out};
  constexpr std::array kNames = {"column line", "settings line", "picture line", "drawer line"};
  begin(kNames[static_cast<std::size_t>(which)], grip);
  hit_area("grip", {grip.width, grip.height});
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
    ImGui::SetMouseCursor(upright ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
    ImGui::GetWindowDrawList()->AddRectFilled(
        {line.x, line.y}, {line.right(), line.bottom()}, imgui_color(Role::accent));
  }
  const ImVec2 at = ImGui::GetIO().MousePos;
  const Division& now = input.state.view.division;
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) {
    push(commands, DivideWindow{automatic(now, which)});
  } else if (ImGui::IsItemActive() && ImGui::IsMouseDragging(0, 1)) {
    push(commands, DivideWindow{dragged(now, which, layout, {at.x, at.y}, input.scale)});
  }
  ImGui::End();
}

}  // namespace

void splitters(const PanelInput& input, const WindowLayout& layout, Commands& commands) {
  for (const Splitter which : kAll) splitter(which, input, layout, commands);
}

}  // namespace gpo
