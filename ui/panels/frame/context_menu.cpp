// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panels.h"

namespace gpo {
namespace {

void draw_subject(const PanelContext& ui, const ContextSubject& subject) {
  ImGui::PushFont(font(Font::small));
  ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(Role::text_dim));
  wrapped_text(subject.title, ImGui::GetCursorPosX() + 22 * ImGui::GetFontSize());
  ImGui::PopStyleColor();
  ImGui::PopFont();
  for (const ContextEntry& entry : context_entries()) {
    if (entry.kind != subject.kind) continue;
    const std::string line = entry.line(ui.state, subject);
    if (ImGui::MenuItem(entry.title, nullptr, false, !line.empty()))
      push(ui.commands, RunAction{line});
    if (const auto call = match_line(line)) tooltip(call->action->tooltip);
    if (line.empty() && entry.kind == ContextKind::plane && !subject.ray)
      tooltip(subject.why_not_there);
  }
}

}  // namespace

bool right_clicked(float scale) {
  return ImGui::IsItemHovered() && ImGui::IsMouseReleased(ImGuiMouseButton_Right) &&
         is_click(scale, ImGuiMouseButton_Right);
}

void open_context_menu(const PanelContext& ui, std::vector<ContextSubject> subjects) {
  if (subjects.empty()) return;
  ui.views.context = std::move(subjects);
  ui.views.opens_context = true;
}

void context_menu(const PanelContext& ui) {
  if (std::exchange(ui.views.opens_context, false)) ImGui::OpenPopup("context");
  if (!ImGui::BeginPopup("context")) return;
  for (const ContextSubject& subject : ui.views.context) {
    if (&subject != &ui.views.context.front()) ImGui::Separator();
    draw_subject(ui, subject);
  }
  ImGui::EndPopup();
}

}  // namespace gpo
