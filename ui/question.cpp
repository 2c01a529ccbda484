// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/question.h"

#include "ui/context/theme.h"

#include <algorithm>
#include <cstdint>

#include <GL/glew.h>
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
  ImGui::PushFont(font(Font::heading));
  ImGui::TextWrapped("%s", question.title.c_str());
  ImGui::PopFont();
  ImGui::Dummy({1, 6 * scale});
  ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(Role::accent));
  for (const std::string& line : question.lines) ImGui::TextWrapped("%s", line.c_str());
  ImGui::PopStyleColor();
  ImGui::Dummy({1, 6 * scale});
  ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(Role::text_dim));
  ImGui::TextWrapped("%s", question.advice.c_str());
  ImGui::PopStyleColor();
  ImGui::Dummy({1, 10 * scale});
}

}  // namespace

std::optional<bool> ask(Gui& gui, cv::Size size, const Question& question) {
  const float s = gui.scale();
  std::optional<bool> answer;
  const std::uint32_t background = color_of(Role::background);
  glDisable(GL_SCISSOR_TEST);
  glClearColor(static_cast<float>(red(background)),
               static_cast<float>(green(background)),
               static_cast<float>(blue(background)),
               1);
  glClear(GL_COLOR_BUFFER_BIT);
  gui.begin_frame(size.width, size.height);
  const float width = std::min(640 * s, static_cast<float>(size.width) - 32 * s);
  ImGui::SetNextWindowPos(
      {static_cast<float>(size.width) / 2, static_cast<float>(size.height) / 2}, 0, {0.5F, 0.5F});
  ImGui::SetNextWindowSize({width, 0});
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
