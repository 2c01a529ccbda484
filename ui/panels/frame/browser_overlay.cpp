// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/work/folder_lister.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace gpo {
namespace {

namespace fs = std::filesystem;

constexpr int kRows = 14;

std::string quoted(const fs::path& path) {
  std::ostringstream stream;
  stream << std::quoted(path.string());
  return stream.str();
}

void type_out(BrowserEntry& entry, const std::string& text) {
  entry.text.fill('\0');
  text.copy(entry.text.data(), entry.text.size() - 1);
  entry.typed_out = true;
  entry.chosen = 0;
}

int edit(ImGuiInputTextCallbackData* data) {
  auto& entry = *static_cast<BrowserEntry*>(data->UserData);
  if (data->EventFlag == ImGuiInputTextFlags_CallbackCompletion) {
    const std::string longer =
        completed({data->Buf, static_cast<std::size_t>(data->BufTextLen)}, entry.listed.entries);
    data->DeleteChars(0, data->BufTextLen);
    data->InsertChars(0, longer.c_str());
    return 0;
  }
  if (entry.typed_out) {
    // The field has its own copy of the text while it has the keyboard.
    data->DeleteChars(0, data->BufTextLen);
    data->InsertChars(0, entry.text.data());
    data->CursorPos = data->SelectionStart = data->SelectionEnd = data->BufTextLen;
  }
  entry.typed_out = false;
  return 0;
}

/// Folders to begin from.
void places(const PanelInput& input, BrowserEntry& entry) {
  std::error_code none;
  const auto place = [&](const char* title, const fs::path& folder, bool first = false) {
    if (!first) ImGui::SameLine();
    if (ImGui::SmallButton(title)) type_out(entry, (folder / "").string());
    tooltip(folder.string());
  };
  place("Home", typed_path("~/").folder, true);
  place("Working folder", fs::current_path(none));
  if (!input.example.empty()) place("Examples", input.example.parent_path());
  place("/", "/");
  std::vector<fs::path> seen;
  for (const fs::path& recent : input.state.files.recent) {
    const fs::path folder = recent.parent_path();
    if (seen.size() >= 3 || std::ranges::count(seen, folder) > 0) continue;
    seen.push_back(folder);
    place((folder.filename().string() + "##" + folder.string()).c_str(), folder);
  }
}

/// A row of the list; what it is at the right.
void draw_row(const FolderEntry& entry, bool chosen, bool dim, float width, float scale) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetTextLineHeight() + 6 * scale;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (chosen)
    list.AddRectFilled(at, {at.x + width, at.y + height}, imgui_color(Role::active), 4 * scale);
  const std::string name = entry.name + (entry.folder ? "/" : "");
  const float right = at.x + width - 8 * scale;
  const float what = ImGui::CalcTextSize(entry.what.c_str()).x;
  const ImVec4 clip{at.x, at.y, right - what - 12 * scale, at.y + height};
  list.AddText(ImGui::GetFont(),
               ImGui::GetFontSize(),
               {at.x + 8 * scale, at.y + 3 * scale},
               imgui_color(dim ? Role::text_dim : Role::text),
               name.c_str(),
               nullptr,
               0,
               &clip);
  list.AddText(
      {std::round(right - what), at.y + 3 * scale}, imgui_color(Role::accent), entry.what.c_str());
}

/// The rows that fit, the chosen one lit. That which was clicked, or -1.
int draw_rows(std::span<const FolderEntry> found, int chosen, bool opens, float scale) {
  int clicked = -1;
  const float width = ImGui::GetContentRegionAvail().x;
  const float height = ImGui::GetTextLineHeight() + 6 * scale;
  const int count = static_cast<int>(found.size());
  const int first = std::clamp(chosen - kRows + 1, 0, std::max(0, count - 1));
  for (int i = first; i < std::min(count, first + kRows); ++i) {
    const FolderEntry& entry = found[static_cast<std::size_t>(i)];
    const bool dim = opens && !entry.folder && entry.what.empty();
    draw_row(entry, i == chosen, dim, width, scale);
    ImGui::PushID(i);
    if (hit_area("row", {width, height})) clicked = i;
    ImGui::PopID();
  }
  if (count > first + kRows) ImGui::TextDisabled("%d more", count - first - kRows);
  return clicked;
}

void choose(const PanelInput& input, const fs::path& path, Commands& commands) {
  push(commands, RunAction{"escape"});
  push(commands, RunAction{input.state.view.browse->action + " " + quoted(path)});
}

/// A folder that is no recording is entered; everything else is chosen.
void accept(const PanelInput& input,
            BrowserEntry& entry,
            const FolderEntry* row,
            Commands& commands) {
  const TypedPath typed = typed_path(entry.text.data());
  const bool opens = input.state.view.browse->action == "open";
  std::error_code none;
  if (row != nullptr && row->folder && (!opens || row->what.empty()))
    return type_out(entry, (typed.folder / row->name / "").string());
  if (row != nullptr && opens) return choose(input, typed.folder / row->name, commands);
  if (row != nullptr && typed.name.empty())
    return type_out(entry, (typed.folder / row->name).string());
  if (opens ? fs::exists(typed.whole(), none) : !typed.name.empty())
    choose(input, typed.whole(), commands);
}

void draw_state(const FolderList& list, const TypedPath& typed, bool saves) {
  std::error_code none;
  if (!list.error.empty()) {
    ImGui::TextDisabled("%s: %s", typed.folder.c_str(), list.error.c_str());
  } else if (list.reading && list.entries.empty()) {
    ImGui::TextDisabled("reading the folder ...");
  } else if (saves && !typed.name.empty() && fs::exists(typed.whole(), none)) {
    ImGui::TextDisabled("%s is there already and will be replaced", typed.name.c_str());
  } else {
    ImGui::TextDisabled("Tab completes \u00b7 Up, Down choose \u00b7 Enter %s \u00b7 Esc closes",
                        saves ? "saves" : "opens");
  }
}

/// Whether Enter was pressed.
bool path_field(BrowserEntry& entry) {
  ImGui::SetNextItemWidth(-1);
  if (!ImGui::IsAnyItemActive()) ImGui::SetKeyboardFocusHere();
  return ImGui::InputText("##path",
                          entry.text.data(),
                          entry.text.size(),
                          ImGuiInputTextFlags_EnterReturnsTrue |
                              ImGuiInputTextFlags_CallbackAlways |
                              ImGuiInputTextFlags_CallbackCompletion,
                          edit,
                          &entry);
}

}  // namespace

void browser_overlay(const PanelInput& input,
                     const Rectangle& window,
                     Views& views,
                     Commands& commands) {
  const float s = input.scale;
  const Browse& browse = *input.state.view.browse;
  BrowserEntry& entry = views.browser;
  const bool saves = browse.action != "open";
  if (!entry.open) type_out(entry, browse.text);
  if (!entry.open && saves) entry.chosen = -1;
  entry.open = true;
  const TypedPath typed = typed_path(entry.text.data());
  if (input.lister != nullptr) entry.listed = input.lister->list(typed.folder);
  const std::vector<FolderEntry> found = matching(entry.listed.entries, typed.name);

  const OverlayScope overlay("browser", window, 760 * s, s);
  heading(action_named(browse.action).title.c_str());
  const bool entered = path_field(entry);
  places(input, entry);
  entry.chosen = moved_choice(entry.chosen, saves ? -1 : 0, static_cast<int>(found.size()));
  const int clicked = draw_rows(found, entry.chosen, !saves, s);
  const int row = clicked >= 0 ? clicked : entry.chosen;
  const bool there = row >= 0 && row < static_cast<int>(found.size());
  if (clicked >= 0 || entered)
    accept(input, entry, there ? &found[static_cast<std::size_t>(row)] : nullptr, commands);
  draw_state(entry.listed, typed, saves);
}

}  // namespace gpo
