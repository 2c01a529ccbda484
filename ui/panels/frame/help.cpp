// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Keys, glossary, manual, checks and version in front of the window, and the tour.
#include "engine/version.h"
#include "ui/panels/panels.h"

#include <algorithm>
#include <regex>
#include <sstream>

#include <fmt/format.h>

extern "C" {
extern const char gpo_glossary[], gpo_glossary_end[], gpo_manual[], gpo_manual_end[];
}

#if defined(__clang__)
#define GPO_COMPILER "Clang " __clang_version__
#else
#define GPO_COMPILER "GCC " __VERSION__
#endif

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
      if (!shortcut.label.empty()) row.keys += (row.keys.empty() ? "" : " or ") + shortcut.label;
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
      {"Click", "Select a track, go to a camera's frame, start at a scanned frame"},
      {"Ctrl+Click", "Add a track to the selection, or remove it"},
      {"Right click", "Open the menu of a track, plane, number or frame; reset a setting"},
      {"Drop a file", "Open a recording, a session or a results.csv"}};
  for (const auto& [keys, title] : kMouse) rows.push_back({keys, title, "", ""});
  return rows;
}

/// Returns the width of a table without its wrapped column [px].
float width_beside(std::span<const KeyRow> rows, int columns, float scale) {
  float keys = 0, value = 0;
  for (const KeyRow& row : rows) {
    keys = std::max(keys, ImGui::CalcTextSize(row.keys.c_str()).x);
    value = std::max(value, ImGui::CalcTextSize(row.value.c_str()).x);
  }
  return keys + value + static_cast<float>(16 * columns) * scale;
}

std::vector<KeyRow> glossary_rows() {
  std::vector<KeyRow> rows;
  for (const auto& [term, meaning] : glossary()) rows.push_back({term, meaning, "", ""});
  return rows;
}

std::vector<KeyRow> rows_of_checks() {
  std::vector<KeyRow> rows;
  for (const Check& check : checks())
    rows.push_back({.keys = check.key,
                    .title = check.title,
                    .value = check.may_be_ignored ? "may be ignored" : "",
                    .tooltip = std::string("Looks at: ") + to_string(check.of)});
  return rows;
}

/// `columns`: 2 without the values. `wrap_px`: width of the wrapped column.
void draw_help_row(const KeyRow& row, int columns, float wrap_px) {
  ImGui::TableNextColumn();
  colored_text(Role::accent, row.keys);
  ImGui::TableNextColumn();
  wrapped_text(row.title, ImGui::GetCursorPosX() + wrap_px);
  tooltip(row.tooltip);
  if (columns == 2) return;
  ImGui::TableNextColumn();
  colored_text(row.on ? Role::good : Role::text_dim, row.value);
}

/// Draws the rows in two tables side by side, or in one if the window is too narrow for two.
void draw_halves(std::span<const KeyRow> rows, int columns, float s) {
  constexpr float kWrap = 420, kLeastWrap = 200;  // [px] at scale 1
  const auto flags = ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoHostExtendX;
  const std::size_t half = (rows.size() + 1) / 2;
  const float room = ImGui::GetIO().DisplaySize.x - 72 * s;
  const auto beside = [&](std::span<const KeyRow> part) { return width_beside(part, columns, s); };
  const float of_two = (room - beside(rows.first(half)) - beside(rows.subspan(half))) / 2;
  const bool two = of_two >= kLeastWrap * s;
  const float of_one = std::max(kLeastWrap * s, room - beside(rows));
  const float wrap_px = std::min(kWrap * s, two ? of_two : of_one);
  const auto table = [&](const char* id, std::span<const KeyRow> part) {
    if (!ImGui::BeginTable(id, columns, flags)) return;
    for (const KeyRow& row : part) {
      ImGui::TableNextRow();
      draw_help_row(row, columns, wrap_px);
    }
    ImGui::EndTable();
  };
  table("left", two ? rows.first(half) : rows);
  if (!two) return;
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
  for (const char* name : {"help", "glossary", "manual", "findings", "about"}) {
    const Action& action = action_named(name);
    const bool open = action.checked(ui.state);
    if (open) text_in(Font::heading, color_of(Role::text), action.title);
    if (!open && ImGui::SmallButton(action.title.c_str())) push(ui.commands, RunAction{name});
    if (!open) tooltip(action.tooltip);
    ImGui::SameLine(0, 10 * ui.scale);
  }
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
    const std::size_t bar = line.find(" | ");
    if (!line.starts_with("| ") || bar == std::string::npos) continue;
    rows.push_back({line.substr(2, bar - 2), line.substr(bar + 3, line.size() - bar - 5)});
    std::erase(rows.back().term, '\\');  // escapes bars
  }
  rows.erase(rows.begin(), rows.begin() + std::min<std::ptrdiff_t>(2, std::ssize(rows)));  // head
  return rows;
}

/// Draws Markdown without links, emphasis and code marks: headings larger, tables as text.
void draw_manual(const PanelContext& ui) {
  constexpr float kWidth = 760;  // [px] at scale 1
  const float s = ui.scale;
  const ImVec2 room = ImGui::GetIO().DisplaySize;
  ImGui::BeginChild("manual", {std::min(kWidth * s, room.x - 72 * s), room.y - 140 * s});
  for (const ManualLine& line : manual()) {
    ImGui::PushFont(font(line.heading ? Font::bold : Font::regular));
    if (line.heading) ImGui::Dummy({1, 4 * s});
    wrapped_text(line.text, ImGui::GetContentRegionMax().x);
    ImGui::PopFont();
  }
  ImGui::EndChild();
}

void draw_about() {
  text_in(Font::bold,
          color_of(Role::text),
          fmt::format(
              "GPO Inspector {}.{}.{}", GPO_VERSION_MAJOR, GPO_VERSION_MINOR, GPO_VERSION_PATCH));
  for (const char* line :
       {"built by " GPO_COMPILER ", C++20", "Dear ImGui " IMGUI_VERSION, "License: BSD-3-Clause"})
    ImGui::TextUnformatted(line);
}

/// Removes the marks of links, emphasis and code.
std::string without_marks(std::string text) {
  static const std::regex link("\\[([^\\]]*)\\]\\([^)]*\\)");
  text = std::regex_replace(text, link, "$1");
  std::erase(text, '`');
  std::erase(text, '\\');
  for (std::size_t at = text.find("**"); at != std::string::npos; at = text.find("**"))
    text.erase(at, 2);
  return text;
}

}  // namespace

const std::vector<GlossaryTerm>& glossary() {
  static const auto terms = read_table({gpo_glossary, gpo_glossary_end});
  return terms;
}

const std::vector<ManualLine>& manual() {
  static const std::vector<ManualLine> lines = [] {
    std::vector<ManualLine> all;
    std::istringstream page(std::string(gpo_manual, gpo_manual_end));
    bool code = false;
    for (std::string line; std::getline(page, line);) {
      if (line.starts_with("## Adding to the window")) break;  // for developers
      if (line.starts_with("```")) {
        code = !code;
        continue;
      }
      const std::size_t marks = line.find_first_not_of('#');
      const bool heading = !code && line.starts_with('#') && marks != std::string::npos;
      const bool fresh = line.empty() || line.starts_with("- ") || line.starts_with('|') || code;
      const std::string text = without_marks(heading ? line.substr(marks + 1) : line);
      const bool continues =
          !fresh && !heading && !all.empty() && !all.back().text.empty() && !all.back().heading;
      if (continues)
        all.back().text += " " + text.substr(std::min(text.size(), text.find_first_not_of(' ')));
      else if (!line.starts_with("| ---"))
        all.push_back({text, heading});
    }
    return all;
  }();
  return lines;
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
  const HelpPage page = ui.state.view.help_page;
  ImGui::PushID(static_cast<int>(page));
  if (page == HelpPage::keys) draw_halves(key_rows(ui.state), 3, s);
  if (page == HelpPage::glossary) draw_halves(glossary_rows(), 2, s);
  if (page == HelpPage::manual) draw_manual(ui);
  if (page == HelpPage::findings) draw_halves(rows_of_checks(), 3, s);
  if (page == HelpPage::about) draw_about();
  ImGui::PopID();
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(3);
}

void tour_card(const PanelContext& ui, const Rectangle& window) {
  constexpr const char* kSteps[][2] = {
      {"Open a recording",
       "Drop a video or a folder on the window, or open the example. Everything on the left and "
       "below then follows the window of frames between the two handles of the time line."},
      {"Read the verdict",
       "Top left: ready, weak or degenerate, with the reason. Image and scene show the same "
       "tracks; "
       "point at one to see it in both. Right-click a track, a plane, a number or the time line "
       "for "
       "what can be done with it."},
      {"Change and compare",
       "Settings are on the left, C compares methods side by side, the tabs below show errors and "
       "residuals. Ctrl+P finds every command by its name or meaning, F1 lists the keys, Ctrl+Z "
       "undoes."}};
  const float s = ui.scale;
  const int step = std::clamp(ui.state.view.tour, 1, static_cast<int>(std::size(kSteps)));
  const auto& [title, text] = kSteps[step - 1];
  ImGui::SetNextWindowPos({window.right() - 16 * s, window.bottom() - 140 * s}, 0, {1, 1});
  ImGui::SetNextWindowSize({std::min(380 * s, window.width - 32 * s), 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {16 * s, 12 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_color(Role::active));
  ImGui::Begin("tour",
               nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_AlwaysAutoResize);
  text_in(Font::bold, color_of(Role::text), fmt::format("{} of 3: {}", step, title));
  wrapped_text(text, ImGui::GetContentRegionMax().x);
  ImGui::Dummy({1, 4 * s});
  const bool last = step == std::size(kSteps);
  if (ImGui::SmallButton(last ? "Done" : "Next")) push(ui.commands, RunAction{"tour"});
  ImGui::SameLine();
  if (!last && ImGui::SmallButton("Skip")) push(ui.commands, RunAction{"tour off"});
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(2);
}

}  // namespace gpo
