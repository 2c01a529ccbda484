// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/workbench/actions/actions.h"

#include <algorithm>
#include <sstream>

extern "C" {
extern const char gpo_glossary[], gpo_glossary_end[];
}

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
    for (const Shortcut& shortcut : action.shortcuts)
      row.keys += (row.keys.empty() ? "" : " or ") + shortcut.label;
    if (action.checked) {
      row.on = action.checked(state);
      row.value = row.on ? "on" : "off";
    }
    if (action.value) row.value = action.value(state);
    rows.push_back(std::move(row));
  }
  constexpr const char* kMouse[][2] = {
      {"Wheel", "Zoom image, scene, normals, time line"},
      {"Drag", "Move the image, orbit the scene"},
      {"Shift+Drag", "Select tracks in the image, move the scene"},
      {"Double click", "Fit image or scene"},
      {"Click", "Select a track, go to a camera, start where a scan succeeded"},
      {"Ctrl+Click", "Add a track to the selection, or remove it"},
      {"Right click", "Move the cube here, reset a setting, copy a table"},
      {"Drop a file", "Open a recording, a session or a results.csv"}};
  for (const auto& [keys, title] : kMouse) rows.push_back({keys, title, "", ""});
  return rows;
}

void draw_key(const KeyRow& row, float /*scale*/) {
  ImGui::TableNextColumn();
  colored_text(Role::accent, row.keys);
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(row.title.c_str());
  tooltip(row.tooltip);
  ImGui::TableNextColumn();
  colored_text(row.on ? Role::good : Role::text_dim, row.value);
}

void draw_term(const GlossaryTerm& row, float scale) {
  ImGui::TableNextColumn();
  colored_text(Role::accent, row.term);
  ImGui::TableNextColumn();
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + 420 * scale);
  ImGui::TextUnformatted(row.meaning.c_str());
  ImGui::PopTextWrapPos();
}

/// Draws the rows in two tables side by side.
template <class Row>
void draw_halves(std::span<const Row> rows, int columns, void (*draw)(const Row&, float), float s) {
  const auto flags = ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoHostExtendX;
  const std::size_t half = (rows.size() + 1) / 2;
  const auto table = [&](const char* id, std::span<const Row> part) {
    if (!ImGui::BeginTable(id, columns, flags)) return;
    for (const Row& row : part) {
      ImGui::TableNextRow();
      draw(row, s);
    }
    ImGui::EndTable();
  };
  table("left", rows.first(half));
  ImGui::SameLine(0, 24 * s);
  table("right", rows.subspan(half));
}

/// Dims all panels below the overlay, which a click on them closes.
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

void draw_title(const PanelContext& ui) {
  bool& glossary = ui.views.glossary;
  ImGui::PushFont(font(Font::heading));
  ImGui::TextUnformatted(glossary ? "Glossary" : "Keys");
  ImGui::PopFont();
  ImGui::SameLine(0, 16 * ui.scale);
  if (ImGui::SmallButton(glossary ? "Keys" : "Glossary")) glossary = !glossary;
  tooltip(glossary ? "Lists the keys" : "Explains the terms that the window uses");
  ImGui::SameLine(0, 8 * ui.scale);
  if (ImGui::SmallButton("Find a command (Ctrl+P)")) {
    push(ui.commands, RunAction{"escape"});
    push(ui.commands, RunAction{"palette"});
  }
}

/// Reads the rows of a Markdown table with two columns.
std::vector<GlossaryTerm> read_table(const std::string& page) {
  std::vector<GlossaryTerm> rows;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t between = line.find(" | ");
    if (!line.starts_with("| ") || between == std::string::npos) continue;
    rows.push_back(
        {line.substr(2, between - 2), line.substr(between + 3, line.size() - between - 5)});
    std::erase(rows.back().term, '\\');  // escapes bars
  }
  rows.erase(rows.begin(), rows.begin() + std::min<std::ptrdiff_t>(2, std::ssize(rows)));  // head
  return rows;
}

}  // namespace

const std::vector<GlossaryTerm>& glossary() {
  static const auto terms = read_table({gpo_glossary, gpo_glossary_end});
  return terms;
}

void help_overlay(const PanelContext& ui, const Rectangle& window) {
  const float s = ui.scale;
  dim_window(window, ui.commands);
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
  draw_title(ui);
  if (ui.views.glossary) {
    ImGui::PushID("glossary");
    draw_halves<GlossaryTerm>(glossary(), 2, draw_term, s);
    ImGui::PopID();
  } else {
    draw_halves<KeyRow>(key_rows(ui.state), 3, draw_key, s);
  }
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(3);
}

}  // namespace gpo
