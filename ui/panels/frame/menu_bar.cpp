// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/facts/facts.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/workbench/actions/actions.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace gpo {
namespace {

/// What needs more than a click is chosen, or typed.
std::string line_of_click(const Action& action) {
  if (action.complete()) return action.name;
  if (takes_a_file(action)) return "browse \"" + action.name + "\"";
  return "palette " + action.name;
}

/// Files that were opened before, with their folders.
void recent_menu(const PanelInput& input, Commands& commands) {
  if (!ImGui::BeginMenu("Open recent", !input.state.files.recent.empty())) return;
  for (const std::filesystem::path& path : input.state.files.recent) {
    ImGui::PushID(path.c_str());
    const std::string folder = path.parent_path().string();
    if (ImGui::MenuItem(path.filename().c_str(), folder.c_str())) push(commands, OpenPath{path});
    ImGui::PopID();
  }
  ImGui::EndMenu();
}

void menu_item(const Action& action, const PanelInput& input, Commands& commands) {
  const bool checked = action.checked && action.checked(input.state);
  const std::string keys = action.shortcuts.empty() ? "" : action.shortcuts.front().label;
  const std::string title = action.title + (action.complete() ? "" : " ...");
  if (ImGui::MenuItem(title.c_str(), keys.c_str(), checked, enabled(action, input.state))) {
    push(commands, RunAction{line_of_click(action)});
  }
  tooltip(action.tooltip);
}

/// A submenu is where the first of its actions would be.
void draw_menu(const std::string& menu, const PanelInput& input, Commands& commands) {
  std::set<std::string> drawn;
  for (const Action& action : all_actions(input.state)) {
    if (action.menu != menu) continue;
    if (action.submenu.empty()) menu_item(action, input, commands);
    if (action.name == "browse") recent_menu(input, commands);
    if (action.submenu.empty() || !drawn.insert(action.submenu).second) continue;
    if (!ImGui::BeginMenu(action.submenu.c_str())) continue;
    for (const Action& within : all_actions(input.state))
      if (within.menu == menu && within.submenu == action.submenu)
        menu_item(within, input, commands);
    ImGui::EndMenu();
  }
}

/// The recording in a few words, at the right; the last ones are left out where there is no room.
void draw_facts(const Recording& recording, float scale) {
  const float left = ImGui::GetCursorPosX() + 12 * scale;
  const float right = ImGui::GetWindowWidth() - 12 * scale;
  std::vector<std::string> facts = recording_facts(recording);
  const std::string between = "  \u00b7  ";
  const auto text = [&] {
    std::string all;
    for (const std::string& fact : facts) all += (all.empty() ? "" : between) + fact;
    return all;
  };
  while (facts.size() > 1 && left + ImGui::CalcTextSize(text().c_str()).x > right) facts.pop_back();
  const std::string shown = text();
  ImGui::SetCursorPosX(std::max(left, right - ImGui::CalcTextSize(shown.c_str()).x));
  clipped_text(shown, right - left, color_of(Role::text_dim));
  std::string all = recording.path.string();
  for (const std::string& note : recording.notes) all += "\n" + note;
  tooltip(all);
}

/// To the left of the facts: what to do about something that is not as it should be.
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

void offers(const PanelInput& input, Commands& commands) {
  if (calibration_may_help(input)) offer("calibrate", "The camera is a guess", commands);
  if (another_start_may_help(input.state))
    offer("find-start", "The window cannot be initialized", commands);
}

}  // namespace

void menu_bar(const PanelInput& input, Commands& commands) {
  if (!ImGui::BeginMainMenuBar()) return;
  std::vector<std::string> menus;
  for (const Action& action : actions()) {
    if (menus.empty() || menus.back() != action.menu) menus.push_back(action.menu);
  }
  for (const std::string& menu : menus) {
    if (!ImGui::BeginMenu(menu.c_str())) continue;
    draw_menu(menu, input, commands);
    ImGui::EndMenu();
  }
  if (input.state.document.recording) offers(input, commands);
  if (input.state.document.recording) draw_facts(*input.state.document.recording, input.scale);
  ImGui::EndMainMenuBar();
}

}  // namespace gpo
