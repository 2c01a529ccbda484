// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/views/overlay/overlay.h"
#include "ui/workbench/actions/actions.h"

#include <cmath>

namespace gpo {
namespace {

constexpr int kMostRows = 12;

/// The name with its arguments: what is to be typed.
std::string usage(const Action& action) {
  return action.arguments.empty() ? action.name : action.name + " " + action.arguments;
}

void draw_row(const Action& action, bool chosen, float width, float scale) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetTextLineHeight() + 8 * scale;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto write = [&](float x, std::uint32_t rgb, const std::string& text, float room) {
    list.AddText({std::round(x), at.y + 4 * scale},
                 imgui_color(rgb),
                 fitting_text(Font::regular, {text}, room).c_str());
  };
  if (chosen)
    list.AddRectFilled(at, {at.x + width, at.y + height}, imgui_color(Role::active), 4 * scale);
  const float gap = 8 * scale;
  const float usage_x = 0.45F * width;
  write(at.x + gap, color_of(Role::text), action.title, usage_x - 2 * gap);
  const std::string keys = action.shortcuts.empty() ? "" : action.shortcuts.front().label;
  const float keys_x = width - ImGui::CalcTextSize(keys.c_str()).x - gap;
  write(at.x + usage_x, color_of(Role::text_dim), usage(action), keys_x - usage_x - gap);
  write(at.x + keys_x, color_of(Role::accent), keys, width);
}

/// Rows that fit, the chosen one lit. The one that was clicked, or null.
const Action* draw_rows(const std::vector<Action>& found, int chosen, float scale) {
  const Action* clicked = nullptr;
  const float width = ImGui::GetContentRegionAvail().x;
  const int first = std::max(0, chosen - kMostRows + 1);
  const int last = std::min(static_cast<int>(found.size()), first + kMostRows);
  for (int i = first; i < last; ++i) {
    draw_row(found[i], i == chosen, width, scale);
    ImGui::PushID(i);
    if (hit_area("row", {width, ImGui::GetTextLineHeight() + 8 * scale})) clicked = &found[i];
    tooltip(found[i].tooltip);
    ImGui::PopID();
  }
  return clicked;
}

/// As if somebody had typed it.
void type_out(PaletteEntry& entry, const std::string& text) {
  entry.text.fill('\0');
  text.copy(entry.text.data(), entry.text.size() - 1);
  entry.typed_out = true;
}

/// Runs what was typed where that is a whole command, else what is chosen; one that needs more is
/// typed out as far as it is known.
void accept(PaletteEntry& entry, const Action* chosen, Commands& commands) {
  const std::string typed = entry.text.data();
  if (const auto matched = match_line(typed); matched && !matched->arguments.empty()) {
    push(commands, RunAction{"palette"});
    push(commands, RunAction{typed});
  } else if (chosen != nullptr && chosen->complete()) {
    push(commands, RunAction{"palette"});
    push(commands, RunAction{chosen->name});
  } else if (chosen != nullptr) {
    type_out(entry, chosen->name + " ");
  }
}

/// The actions that the text finds; of a whole command its own, whose usage is then on display.
std::vector<Action> offered(const std::string& text, const WorkbenchState& state) {
  const auto call = match_line(text);
  if (call && !call->arguments.empty()) return {*call->action};
  return find_actions(text, state);
}

int move_cursor_to_end(ImGuiInputTextCallbackData* data) {
  auto& entry = *static_cast<PaletteEntry*>(data->UserData);
  if (entry.typed_out)
    data->CursorPos = data->SelectionStart = data->SelectionEnd = data->BufTextLen;
  entry.typed_out = false;
  return 0;
}

}  // namespace

void palette_overlay(const PanelInput& input,
                     const Rectangle& window,
                     Views& views,
                     Commands& commands) {
  const float s = input.scale;
  PaletteEntry& entry = views.palette;
  if (!entry.open && !input.state.view.palette->empty())
    type_out(entry, *input.state.view.palette + " ");
  entry.open = true;
  const OverlayScope overlay("palette", window, 640 * s, s);
  ImGui::SetNextItemWidth(-1);
  if (!ImGui::IsAnyItemActive()) ImGui::SetKeyboardFocusHere();
  const bool entered = ImGui::InputTextWithHint(
      "##command",
      "A part of a command's name, or a whole command, e.g. frame 40",
      entry.text.data(),
      entry.text.size(),
      ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackAlways,
      move_cursor_to_end,
      &entry);
  const std::vector<Action> found = offered(entry.text.data(), input.state);
  entry.chosen = moved_choice(entry.chosen, 0, static_cast<int>(found.size()));
  const Action* clicked = draw_rows(found, entry.chosen, s);
  if (clicked != nullptr) accept(entry, clicked, commands);
  if (entered) accept(entry, found.empty() ? nullptr : &found[entry.chosen], commands);
  if (found.empty()) ImGui::TextUnformatted("No command has such a name; F1 lists the keys");
}

}  // namespace gpo
