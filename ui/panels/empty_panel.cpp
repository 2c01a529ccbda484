// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/views/palette.h"

#include <cmath>

namespace gpo {
namespace {

void centered(const char* text, const Rectangle& place) {
  const float width = ImGui::CalcTextSize(text).x;
  ImGui::SetCursorPosX(std::round((place.width - width) / 2));
  ImGui::TextUnformatted(text);
}

}  // namespace

void empty_panel(const PanelInput& input, const Rectangle& place, Commands& commands) {
  const float s = input.scale;
  const PanelScope panel("empty", place, {0, 0});
  const float inset = std::round(24 * s);
  ImGui::GetWindowDrawList()->AddRect({place.x + inset, place.y + inset},
                                      {place.right() - inset, place.bottom() - inset},
                                      imgui_color(palette::kBorder),
                                      8 * s,
                                      0,
                                      2 * s);
  ImGui::SetCursorPosY(std::round(place.height / 2 - 70 * s));
  if (input.worker.busy) {
    ImGui::PushFont(font(Font::heading));
    centered("Opening the recording ...", place);
    ImGui::PopFont();
    return;
  }
  ImGui::PushFont(font(Font::heading));
  centered("Drop a recording here", place);
  ImGui::PopFont();
  ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(palette::kTextDim));
  centered("an EuRoC folder, a video or a folder of images with camera.yaml,", place);
  centered("or tracks.csv with a calibration", place);
  ImGui::PopStyleColor();
  ImGui::Dummy({1, 8 * s});
  const char* title = "Open the example";
  const float width = ImGui::CalcTextSize(title).x + 32 * s;
  ImGui::SetCursorPosX(std::round((place.width - width) / 2));
  ImGui::PushStyleColor(ImGuiCol_Button, imgui_color(palette::kActive));
  if (ImGui::Button(title, {width, 32 * s})) push(commands, RunAction{"open-example"});
  ImGui::PopStyleColor();
}

}  // namespace gpo
