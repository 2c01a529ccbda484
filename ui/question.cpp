// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/question.h"

#include "ui/context/theme.h"
#include "ui/panels/widgets.h"

#include <algorithm>

#include <imgui.h>

namespace gpo {
namespace {

bool button(const std::string& title, float scale, bool first) {
  if (first) ImGui::PushStyleColor(ImGuiCol_Button, imgui_color(Role::active));
  const float width = ImGui::CalcTextSize(title.c_str()).x + 48 * scale;
  const bool clicked = ImGui::Button(title.c_str(), {std::max(width, 120 * scale), 32 * scale});
  if (first) ImGui::PopStyleColor();
  return clicked;
}

void write(const Question& question, float scale) {
  const auto wrapped = [](Role role, const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(role));
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopStyleColor();
  };
  ImGui::PushFont(font(Font::heading));
  wrapped(Role::text, question.title);
  ImGui::PopFont();
  ImGui::Dummy({1, 6 * scale});
  for (const std::string& line : question.lines) wrapped(Role::accent, line);
  ImGui::Dummy({1, 6 * scale});
  wrapped(Role::text_dim, question.advice);
  ImGui::Dummy({1, 10 * scale});
}

}  // namespace

std::optional<bool> ask(Gui& gui, cv::Size size, const Question& question) {
  const float s = gui.scale();
  const auto window_width = static_cast<float>(size.width);
  std::optional<bool> answer;
  clear_framebuffer(color_of(Role::background));
  gui.begin_frame(size.width, size.height);
  ImGui::SetNextWindowPos({window_width / 2, static_cast<float>(size.height) / 2}, 0, {0.5F, 0.5F});
  ImGui::SetNextWindowSize({std::min(640 * s, window_width - 32 * s), 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {24 * s, 20 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_color(Role::raised));
  ImGui::Begin("question",
               nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  write(question, s);
  if (button(question.no, s, true)) answer = false;
  ImGui::SameLine(0, 12 * s);
  if (button(question.yes, s, false)) answer = true;
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) answer = false;
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(2);
  gui.end_frame();
  return answer;
}

}  // namespace gpo
