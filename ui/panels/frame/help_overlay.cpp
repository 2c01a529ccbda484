// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/workbench/actions/actions.h"

#include <array>
#include <cmath>

namespace gpo {
namespace {

struct KeyRow {
  std::string keys, title, value, tooltip;
  bool on = false;
};

std::vector<KeyRow> key_rows(const WorkbenchState& state) {
  std::vector<KeyRow> rows;
  for (const Action& action : actions()) {
    if (action.shortcuts.empty()) continue;
    const bool method = action.menu == "Method" && action.name.starts_with("method ");
    KeyRow row{"", (method ? "Method " : "") + action.title, "", action.tooltip};
    for (const Shortcut& shortcut : action.shortcuts) {
      row.keys += (row.keys.empty() ? "" : " or ") + shortcut.label;
    }
    if (action.checked) {
      row.on = action.checked(state);
      row.value = row.on ? "on" : "off";
    }
    if (action.value) row.value = action.value(state);
    rows.push_back(std::move(row));
  }
  const std::array<std::array<const char*, 2>, 8> mouse = {
      {{"Wheel", "Zoom picture, scene, normals"},
       {"Drag", "Move the picture, turn the scene"},
       {"Shift+Drag", "Pick tracks in the picture, move the scene"},
       {"Double click", "Fit picture or scene"},
       {"Click", "Pick a track, go to a camera, start where a scan succeeded"},
       {"Ctrl+Click", "Pick several tracks"},
       {"Right click", "Put the cube there; reset a setting; copy a table"},
       {"Drop a file", "Open a recording, a session, a results.csv"}}};
  for (const auto& [keys, title] : mouse) rows.push_back({keys, title, "", ""});
  return rows;
}

void draw_row(const KeyRow& row) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  colored_text(Role::accent, row.keys);
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(row.title.c_str());
  tooltip(row.tooltip);
  ImGui::TableNextColumn();
  colored_text(row.on ? Role::good : Role::text_dim, row.value);
}

void draw_table(const char* id, const std::vector<KeyRow>& rows, std::size_t from, std::size_t to) {
  if (!ImGui::BeginTable(id, 3, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoHostExtendX)) {
    return;
  }
  for (std::size_t i = from; i < to; ++i) draw_row(rows[i]);
  ImGui::EndTable();
}

/// Over all panels, which never come to the front, and below the list. A click on it closes the
/// list.
void dim_window(const Rectangle& window, Commands& commands) {
  ImGui::SetNextWindowFocus();
  ImGui::SetNextWindowPos({window.x, window.y});
  ImGui::SetNextWindowSize({window.width, window.height});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_color(Role::background, 0.6));
  ImGui::Begin(
      "dim",
      nullptr,
      ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  if (ImGui::IsWindowHovered() && ImGui::IsMouseClicked(0)) push(commands, RunAction{"escape"});
  ImGui::End();
  ImGui::PopStyleColor();
}

}  // namespace

void help_overlay(const PanelInput& input, const Rectangle& window, Commands& commands) {
  const float s = input.scale;
  dim_window(window, commands);
  ImGui::SetNextWindowFocus();
  ImGui::SetNextWindowPos(
      {window.x + window.width / 2, window.y + window.height / 2}, 0, {0.5F, 0.5F});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {window.width - 8 * s, window.height - 8 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {20 * s, 16 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {8 * s, 3 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_color(Role::raised));
  ImGui::Begin("keys",
               nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PushFont(font(Font::heading));
  ImGui::TextUnformatted("Keys");
  ImGui::PopFont();
  ImGui::SameLine(0, 16 * s);
  if (ImGui::SmallButton("all commands, to search (Ctrl+P)")) {
    push(commands, RunAction{"escape"});
    push(commands, RunAction{"palette"});
  }
  const std::vector<KeyRow> rows = key_rows(input.state);
  const std::size_t half = (rows.size() + 1) / 2;
  draw_table("left", rows, 0, half);
  ImGui::SameLine(0, 24 * s);
  draw_table("right", rows, half, rows.size());
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(3);
}

}  // namespace gpo
