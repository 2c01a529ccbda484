// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The findings below the verdict.
#include "ui/panels/panels.h"
#include "ui/views/overlay/overlay.h"

#include <algorithm>

namespace gpo {
namespace {

Sign sign_of(const FindingRow& row) {
  if (row.finding.level == Level::note) return Sign::dot;
  return row.finding.level == Level::weak ? Sign::triangle : Sign::cross;
}

/// Draws level, key, sentence and advice as one item.
void draw_texts(const FindingRow& row, float left, float right, float indent) {
  const auto paragraph = [&](Role role, const std::string& text) {
    if (text.empty()) return;
    ImGui::SetCursorPosX(left + indent);
    ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(role));
    wrapped_text(text, right);
    ImGui::PopStyleColor();
  };
  ImGui::BeginGroup();
  sign_at_cursor(sign_of(row), color_of(row.color));
  ImGui::SetCursorPosX(left + indent);
  colored_text(row.color, row.word);
  const float key = right - ImGui::CalcTextSize(row.finding.key.c_str()).x;
  const float word = left + indent + ImGui::CalcTextSize((row.word + " ").c_str()).x;
  if (key >= word) {
    continue_line_at(key);
    colored_text(Role::text_dim, row.finding.key);
  }
  paragraph(row.finding.ignored ? Role::text_dim : Role::text, row.finding.sentence);
  paragraph(Role::text_dim, row.finding.advice);
  ImGui::EndGroup();
}

/// Adds a button to the line if it fits, else to a new line.
bool small_button(const std::string& label, float& at, float left, float right) {
  const float width = ImGui::CalcTextSize(label.c_str()).x + 2 * ImGui::GetStyle().FramePadding.x;
  if (at > left && at + width <= right)
    continue_line_at(at);
  else
    ImGui::SetCursorPosX(at = left);
  at += width + ImGui::GetStyle().ItemSpacing.x;
  return ImGui::SmallButton(label.c_str());
}

void draw_buttons(const PanelContext& ui, const FindingRow& row, float left, float right) {
  const auto& [key, command] = std::tie(row.finding.key, row.finding.command);
  float at = left;
  if (!command.empty()) {
    const bool fits = left + ImGui::CalcTextSize((command + "  ").c_str()).x <= right;
    if (small_button(fits ? command : "run", at, left, right))
      push(ui.commands, RunAction{"run-finding " + key});
    tooltip("Runs the command " + command);
  }
  const bool counts = row.finding.level != Level::note;
  if (!row.may_be_ignored || !(counts || row.finding.ignored)) return;
  if (small_button(row.finding.ignored ? "do not ignore" : "ignore", at, left, right))
    push(ui.commands, RunAction{"ignore-finding " + key + (row.finding.ignored ? " off" : " on")});
  tooltip("Judges the window with or without this finding. Ctrl+Z undoes it");
}

}  // namespace

void findings_group(const PanelContext& ui, float left, float right) {
  const std::vector<FindingRow> rows = finding_rows(ui.inspection());
  std::string hovered;
  if (!rows.empty()) heading("FINDINGS");
  ImGui::PushFont(font(Font::small));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * ui.scale, ui.scale});
  const float indent = std::round(18 * ui.scale);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const FindingRow& row = rows[i];
    ImGui::PushID(static_cast<int>(i));
    ImGui::SetCursorPosX(left);
    draw_texts(row, left, right, indent);
    if (ImGui::IsItemHovered()) hovered = row.finding.key;
    if (ImGui::IsItemClicked()) push(ui.commands, RunAction{"finding " + row.finding.key});
    tooltip(row.title + ". Click to select its tracks, go to its frame and open its view");
    draw_buttons(ui, row, left + indent, right);
    ImGui::Dummy({1, 2 * ui.scale});
    ImGui::PopID();
  }
  ImGui::PopStyleVar();
  ImGui::PopFont();
  if (hovered != ui.state.hover.finding) push(ui.commands, HoverOver{{.finding = hovered}});
}

}  // namespace gpo
