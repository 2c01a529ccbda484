// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Menu bar, status line, the lines between the parts of the window, and the help.
#include "ui/panels/panels.h"

#include <algorithm>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

extern "C" {
extern const char gpo_glossary[], gpo_glossary_end[];
}

namespace gpo {
namespace {

/// Returns the line to run; an action with arguments opens the file browser or the palette.
std::string line_of_click(const Action& action) {
  if (action.complete()) return action.name;
  if (takes_a_file(action)) return "browse \"" + action.name + "\"";
  return "palette " + action.name;
}

void recent_menu(const PanelContext& ui) {
  if (!ImGui::BeginMenu("Open recent", !ui.state.files.recent.empty())) return;
  for (const fs::path& path : ui.state.files.recent) {
    ImGui::PushID(path.c_str());
    const std::string folder = path.parent_path().string();
    if (ImGui::MenuItem(path.filename().c_str(), folder.c_str())) push(ui.commands, OpenPath{path});
    ImGui::PopID();
  }
  ImGui::EndMenu();
}

void menu_item(const Action& action, const PanelContext& ui) {
  const bool checked = action.checked && action.checked(ui.state);
  const std::string keys = action.shortcuts.empty() ? "" : action.shortcuts.front().label;
  const std::string title = action.title + (action.complete() ? "" : " ...");
  if (ImGui::MenuItem(title.c_str(), keys.c_str(), checked, enabled(action, ui.state)))
    push(ui.commands, RunAction{line_of_click(action)});
  tooltip(action.tooltip);
}

/// A submenu takes the place of the first of its actions.
void draw_menu(const std::string& menu, const PanelContext& ui) {
  std::set<std::string> drawn;
  for (const Action& action : all_actions(ui.state)) {
    if (action.menu != menu) continue;
    if (action.submenu.empty()) menu_item(action, ui);
    if (action.name == "browse") recent_menu(ui);
    if (action.submenu.empty() || !drawn.insert(action.submenu).second) continue;
    if (!ImGui::BeginMenu(action.submenu.c_str())) continue;
    for (const Action& within : all_actions(ui.state))
      if (within.menu == menu && within.submenu == action.submenu) menu_item(within, ui);
    ImGui::EndMenu();
  }
}

/// The recording's facts at the right; the last ones are left out if there is no room.
void draw_recording(const Recording& recording, float scale) {
  const float left = ImGui::GetCursorPosX() + 12 * scale;
  const float right = ImGui::GetWindowWidth() - 12 * scale;
  std::vector<std::string> facts = recording_facts(recording);
  const auto text = [&] { return fmt::format("{}", fmt::join(facts, "  \u00b7  ")); };
  while (facts.size() > 1 && left + ImGui::CalcTextSize(text().c_str()).x > right) facts.pop_back();
  const std::string shown = text();
  ImGui::SetCursorPosX(std::max(left, right - ImGui::CalcTextSize(shown.c_str()).x));
  clipped_text(shown, right - left, color_of(Role::text_dim));
  std::string all = recording.path.string();
  for (const std::string& note : recording.notes) all += "\n" + note;
  tooltip(all);
}

/// A button that solves a problem, with the problem in its tooltip.
void offer(const std::string& name, const std::string& why, Commands& commands) {
  const Action& action = action_named(name);
  ImGui::PushStyleColor(ImGuiCol_Button, imgui_color(Role::active));
  if (ImGui::SmallButton(action.title.c_str())) push(commands, RunAction{action.name});
  ImGui::PopStyleColor();
  tooltip(why + ". " + action.tooltip);
}

bool calibration_may_help(const PanelInput& input) {
  const Recording& recording = *input.state.document.recording;
  const bool calibrating = input.worker.busy && input.worker.stage.starts_with("calibrating");
  return recording.camera_source == CameraSource::guess && recording.images && !calibrating;
}

bool another_start_may_help(const WorkbenchState& state) {
  const Inspection* inspection = state.results.inspection.get();
  return inspection != nullptr && inspection->initialization && !inspection->initialization->ok &&
         state.frame_count() > state.document.settings.frames && !state.results.scan;
}

/// Returns the running job that the user waits for most; null if none runs.
const JobStatus* current_job(const PanelInput& input) {
  for (const JobStatus* job : {&input.writing, &input.worker, &input.survey, &input.scan})
    if (job->busy) return job;
  return nullptr;
}

void draw_progress_bar(float done, float scale) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size(140 * scale, std::round(8 * scale));
  const float y = std::round(at.y + (ImGui::GetTextLineHeight() - size.y) / 2);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto bar = [&](float width, Role role) {
    list.AddRectFilled({at.x, y}, {at.x + width, y + size.y}, imgui_color(role), size.y / 2);
  };
  bar(size.x, Role::raised);
  bar(std::max(size.y, size.x * std::clamp(done, 0.0F, 1.0F)), Role::accent);
  ImGui::Dummy({size.x, ImGui::GetTextLineHeight()});
  ImGui::SameLine();
}

/// Returns where its text ends [px from the panel's left edge].
float draw_progress(const JobStatus& job, float scale) {
  const std::string stage = job.stage.empty() ? "waiting" : job.stage;
  const std::string text = job.of > 0 ? fmt::format("{} {}/{}", stage, job.done, job.of) : stage;
  ImGui::TextUnformatted(text.c_str());
  // At a fixed position: a bar that moves with its text is hard to read.
  ImGui::SameLine(std::max(190 * scale, ImGui::CalcTextSize(text.c_str()).x + 24 * scale));
  if (job.of > 0)
    draw_progress_bar(static_cast<float>(job.done) / static_cast<float>(job.of), scale);
  colored_text(Role::text_dim, "Esc cancels");
  ImGui::SameLine();
  return ImGui::GetCursorPosX() + 12 * scale;
}

void splitter(Splitter which, const PanelContext& ui, const WindowLayout& layout) {
  constexpr float kGrip = 7;  // wide enough to hit [px]
  constexpr std::array kNames = {"column line", "settings line", "image line", "drawer line"};
  const Rectangle line = place_of(which, layout, ui.scale);
  if (line.empty()) return;
  const bool upright = line.height > line.width;
  const float out = std::round((kGrip * ui.scale - (upright ? line.width : line.height)) / 2);
  const Rectangle grip = upright
                             ? Rectangle{line.x - out, line.y, line.width + 2 * out, line.height}
                             : Rectangle{line.x, line.y - out, line.width, line.height + 2 * out};
  const PanelScope scope(kNames[static_cast<std::size_t>(which)], grip, {0, 0}, PanelKind::over);
  hit_area("grip", {grip.width, grip.height});
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
    ImGui::SetMouseCursor(upright ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
    ImGui::GetWindowDrawList()->AddRectFilled(
        {line.x, line.y}, {line.right(), line.bottom()}, imgui_color(Role::accent));
  }
  const ImVec2 at = ImGui::GetIO().MousePos;
  const Division& now = ui.state.view.division;
  if (is_item_double_clicked())
    push(ui.commands, DivideWindow{automatic(now, which)});
  else if (ImGui::IsItemActive() && ImGui::IsMouseDragging(0, 1))
    push(ui.commands, DivideWindow{dragged(now, which, layout, {at.x, at.y}, ui.scale)});
}

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
      {"Click", "Select a track, go to a camera's frame, start at a scanned frame"},
      {"Ctrl+Click", "Add a track to the selection, or remove it"},
      {"Right click", "Move the cube here, reset a setting, copy a table"},
      {"Drop a file", "Open a recording, a session or a results.csv"}};
  for (const auto& [keys, title] : kMouse) rows.push_back({keys, title, "", ""});
  return rows;
}

/// Returns the width of a table without its wrapped column [px].
float width_beside(std::span<const KeyRow> rows, float scale) {
  float keys = 0, value = 0;
  for (const KeyRow& row : rows) {
    keys = std::max(keys, ImGui::CalcTextSize(row.keys.c_str()).x);
    value = std::max(value, ImGui::CalcTextSize(row.value.c_str()).x);
  }
  return keys + value + 48 * scale;
}
float width_beside(std::span<const GlossaryTerm> rows, float scale) {
  float term = 0;
  for (const GlossaryTerm& row : rows)
    term = std::max(term, ImGui::CalcTextSize(row.term.c_str()).x);
  return term + 32 * scale;
}

/// `wrap_px`: width of the wrapped column.
void draw_key(const KeyRow& row, float wrap_px) {
  ImGui::TableNextColumn();
  colored_text(Role::accent, row.keys);
  ImGui::TableNextColumn();
  wrapped_text(row.title, ImGui::GetCursorPosX() + wrap_px);
  tooltip(row.tooltip);
  ImGui::TableNextColumn();
  colored_text(row.on ? Role::good : Role::text_dim, row.value);
}

void draw_term(const GlossaryTerm& row, float wrap_px) {
  ImGui::TableNextColumn();
  colored_text(Role::accent, row.term);
  ImGui::TableNextColumn();
  wrapped_text(row.meaning, ImGui::GetCursorPosX() + wrap_px);
}

/// Draws the rows in two tables side by side, or in one if the window is too narrow for two.
template <class Row>
void draw_halves(std::span<const Row> rows, int columns, void (*draw)(const Row&, float), float s) {
  constexpr float kWrap = 420, kLeastWrap = 200;  // [px] at scale 1
  const auto flags = ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoHostExtendX;
  const std::size_t half = (rows.size() + 1) / 2;
  const float room = ImGui::GetIO().DisplaySize.x - 72 * s;
  const float of_two =
      (room - width_beside(rows.first(half), s) - width_beside(rows.subspan(half), s)) / 2;
  const bool two = of_two >= kLeastWrap * s;
  const float of_one = std::max(kLeastWrap * s, room - width_beside(rows, s));
  const float wrap_px = std::min(kWrap * s, two ? of_two : of_one);
  const auto table = [&](const char* id, std::span<const Row> part) {
    if (!ImGui::BeginTable(id, columns, flags)) return;
    for (const Row& row : part) {
      ImGui::TableNextRow();
      draw(row, wrap_px);
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
  bool& glossary = ui.views.glossary;
  text_in(Font::heading, color_of(Role::text), glossary ? "Glossary" : "Keys");
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
    const std::size_t bar = line.find(" | ");
    if (!line.starts_with("| ") || bar == std::string::npos) continue;
    rows.push_back({line.substr(2, bar - 2), line.substr(bar + 3, line.size() - bar - 5)});
    std::erase(rows.back().term, '\\');  // escapes bars
  }
  rows.erase(rows.begin(), rows.begin() + std::min<std::ptrdiff_t>(2, std::ssize(rows)));  // head
  return rows;
}

}  // namespace

void menu_bar(const PanelContext& ui) {
  if (!ImGui::BeginMainMenuBar()) return;
  std::vector<std::string> menus;
  for (const Action& action : actions())
    if (menus.empty() || menus.back() != action.menu) menus.push_back(action.menu);
  for (const std::string& menu : menus) {
    if (!ImGui::BeginMenu(menu.c_str())) continue;
    draw_menu(menu, ui);
    ImGui::EndMenu();
  }
  if (ui.state.document.recording) {
    if (calibration_may_help(ui))
      offer("calibrate", "No calibration: the field of view is guessed", ui.commands);
    if (another_start_may_help(ui.state))
      offer("find-start", "The window cannot be initialized", ui.commands);
    draw_recording(*ui.state.document.recording, ui.scale);
  }
  ImGui::EndMainMenuBar();
}

void status_line(const PanelContext& ui, const Rectangle& place) {
  const float s = ui.scale;
  const float padding = std::round((place.height - ImGui::GetTextLineHeight()) / 2);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_color(Role::background));
  {
    const PanelScope scope("status", place, {12 * s, padding});
    const float right = place.width - 12 * s;
    const bool failed = !ui.worker.error.empty();
    const std::string& message = failed ? ui.worker.error : ui.state.messages.text;
    const Severity severity = failed            ? Severity::error
                              : message.empty() ? Severity::note
                                                : ui.state.messages.severity;
    const std::uint32_t color = color_of(role_of(severity, Role::text_dim));
    if (const JobStatus* job = current_job(ui)) {
      const float left = draw_progress(*job, s);
      ImGui::SetCursorPosX(std::max(left, right - ImGui::CalcTextSize(message.c_str()).x));
      clipped_text(message, right - left, color);
    } else {
      const char* hint = "F1 lists the keys and explains the terms, Ctrl+P finds every command";
      clipped_text(message.empty() ? hint : message, right - 12 * s, color);
    }
  }
  ImGui::PopStyleColor();
}

void splitters(const PanelContext& ui, const WindowLayout& layout) {
  for (const Splitter which :
       {Splitter::column, Splitter::settings, Splitter::image, Splitter::drawer})
    splitter(which, ui, layout);
}

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
