// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Command palette, file browser and list of cameras: a text field above a list of what matches it.
#include "ui/panels/panels.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

/// Number of rows that are shown, and the padding between them at scale 1 [px].
struct ListShape {
  int rows;
  float padding;
  bool counts_rest;  ///< shows how many rows are left out
};
constexpr ListShape kCommands{12, 8, false}, kFiles{14, 6, true}, kModes{14, 8, true};

/// A list in front of the window, in its upper middle.
class OverlayScope {
 public:
  OverlayScope(const char* name, const Rectangle& window, float width, float scale) {
    width = std::min(width, window.width - 16 * scale);
    ImGui::SetNextWindowFocus();
    ImGui::SetNextWindowPos({std::round((window.width - width) / 2), std::round(60 * scale)});
    ImGui::SetNextWindowSize({width, 0});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_color(Role::raised));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * scale);
    ImGui::Begin(name,
                 nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize);
  }
  ~OverlayScope() {
    ImGui::End();
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
  }
  OverlayScope(const OverlayScope&) = delete;
  OverlayScope& operator=(const OverlayScope&) = delete;
};

/// Sets the text as if the user had typed it.
void type_out(ListEntry& entry, const std::string& text) {
  entry.text.fill('\0');
  text.copy(entry.text.data(), entry.text.size() - 1);
  entry.typed_out = true;
}

int edit(ImGuiInputTextCallbackData* data) {
  auto& entry = *static_cast<ListEntry*>(data->UserData);
  const auto replace = [data](const std::string& text) {
    data->DeleteChars(0, data->BufTextLen);
    data->InsertChars(0, text.c_str());
  };
  if (data->EventFlag == ImGuiInputTextFlags_CallbackCompletion) {
    replace(
        completed({data->Buf, static_cast<std::size_t>(data->BufTextLen)}, entry.listed.entries));
    return 0;
  }
  if (entry.typed_out) {
    // The field has its own copy of the text while it has the keyboard focus.
    replace(entry.text.data());
    data->CursorPos = data->SelectionStart = data->SelectionEnd = data->BufTextLen;
  }
  entry.typed_out = false;
  return 0;
}

/// Returns whether Enter was pressed. `flags`: in addition to those of every list.
bool text_field(ListEntry& entry, const char* hint, ImGuiInputTextFlags flags = 0) {
  ImGui::SetNextItemWidth(-1);
  if (!ImGui::IsAnyItemActive()) ImGui::SetKeyboardFocusHere();
  flags |= ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackAlways;
  return ImGui::InputTextWithHint(
      "##text", hint, entry.text.data(), entry.text.size(), flags, edit, &entry);
}

/// Returns `chosen` after the arrow keys Up and Down, clamped to the rows that begin at `first`.
int moved_choice(int chosen, int first, int rows) {
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_DownArrow))) ++chosen;
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_UpArrow))) --chosen;
  return std::clamp(chosen, first, std::max(0, rows - 1));
}

/// Draws the rows around the chosen one by `draw(item, width)`. Returns the clicked one or -1.
template <class Item, class Draw>
int draw_rows(std::span<const Item> found,
              int chosen,
              const ListShape& shape,
              float scale,
              const Draw& draw) {
  int clicked = -1;
  const float width = ImGui::GetContentRegionAvail().x;
  const float height = ImGui::GetTextLineHeight() + shape.padding * scale;
  const int count = static_cast<int>(found.size());
  const int first = std::clamp(chosen - shape.rows + 1, 0, std::max(0, count - 1));
  for (int i = first; i < std::min(count, first + shape.rows); ++i) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (i == chosen)
      ImGui::GetWindowDrawList()->AddRectFilled(
          at, {at.x + width, at.y + height}, imgui_color(Role::active), 4 * scale);
    const Item& item = found[static_cast<std::size_t>(i)];
    draw(item, width);
    ImGui::PushID(i);
    if (hit_area("row", {width, height})) clicked = i;
    if constexpr (requires { item.tooltip; }) tooltip(item.tooltip);
    ImGui::PopID();
  }
  if (shape.counts_rest && count > first + shape.rows)
    ImGui::TextDisabled("%d more", count - first - shape.rows);
  return clicked;
}

/// Writes the columns of a row, each shortened to its room.
struct RowWriter {
  ImVec2 at;
  float scale;

  void operator()(float x, Role role, const std::string& text, float room) const {
    const std::string shown = fitting_text(Font::regular, {text}, room);
    ImGui::GetWindowDrawList()->AddText(
        {std::round(at.x + x), at.y + 4 * scale}, imgui_color(role), shown.c_str());
  }
};

void draw_command(const Action& action, float width, float scale) {
  const RowWriter write{ImGui::GetCursorScreenPos(), scale};
  const float gap = 8 * scale;
  const float usage_x = 0.45F * width;
  const std::string keys = action.shortcuts.empty() ? "" : action.shortcuts.front().label;
  const float keys_x = width - ImGui::CalcTextSize(keys.c_str()).x - gap;
  const std::string space = action.arguments.empty() ? "" : " ";
  const std::string usage = action.name + space + action.arguments;
  write(gap, Role::text, action.title, usage_x - 2 * gap);
  write(usage_x, Role::text_dim, usage, keys_x - usage_x - gap);
  write(keys_x, Role::accent, keys, width);
}

/// Runs the text if it is a complete command, else the chosen action, or types it out.
void accept_command(ListEntry& entry, const Action* chosen, Commands& commands) {
  const std::string typed = entry.text.data();
  const auto matched = match_line(typed);
  const bool complete = matched && !matched->arguments.empty();
  if (!complete && chosen == nullptr) return;
  if (!complete && !chosen->complete()) return type_out(entry, chosen->name + " ");
  push(commands, RunAction{"palette"});
  push(commands, RunAction{complete ? typed : chosen->name});
}

void folder_buttons(const PanelContext& ui, ListEntry& entry) {
  std::error_code none;
  const auto button = [&](const std::string& title, const fs::path& folder, bool first = false) {
    if (!first) ImGui::SameLine();
    if (ImGui::SmallButton(title.c_str())) {
      type_out(entry, (folder / "").string());
      entry.chosen = 0;
    }
    tooltip(folder.string());
  };
  button("Home", typed_path("~/").folder, true);
  button("Working folder", fs::current_path(none));
  if (!ui.example.empty()) button("Examples", ui.example.parent_path());
  button("/", "/");
  std::vector<fs::path> seen;
  for (const fs::path& recent : ui.state.files.recent) {
    const fs::path folder = recent.parent_path();
    if (seen.size() >= 3 || std::ranges::count(seen, folder) > 0) continue;
    seen.push_back(folder);
    button(folder.filename().string() + "##" + folder.string(), folder);
  }
}

void draw_file(const FolderEntry& entry, bool dim, float width, float scale) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetTextLineHeight() + kFiles.padding * scale;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const std::string name = entry.name + (entry.folder ? "/" : "");
  const float right = at.x + width - 8 * scale;
  const float kind = ImGui::CalcTextSize(entry.what.c_str()).x;
  const ImVec4 clip{at.x, at.y, right - kind - 12 * scale, at.y + height};
  const ImVec2 start(at.x + 8 * scale, at.y + 3 * scale);
  const ImU32 color = imgui_color(dim ? Role::text_dim : Role::text);
  const float size = ImGui::GetFontSize();
  list.AddText(ImGui::GetFont(), size, start, color, name.c_str(), nullptr, 0, &clip);
  list.AddText(
      {std::round(right - kind), at.y + 3 * scale}, imgui_color(Role::accent), entry.what.c_str());
}

void choose(const PanelContext& ui, const fs::path& path) {
  push(ui.commands, RunAction{"escape"});
  push(ui.commands, RunAction{ui.state.view.browse->action + " " + as_argument(path.string())});
}

/// Enters a folder that is no recording; chooses anything else. `row`: null if none.
void accept_file(const PanelContext& ui, ListEntry& entry, const FolderEntry* row) {
  const TypedPath typed = typed_path(entry.text.data());
  const bool opens = ui.state.view.browse->action == "open";
  const bool enters = row != nullptr && row->folder && (!opens || row->what.empty());
  std::error_code none;
  if (enters || (row != nullptr && !opens && typed.name.empty())) {
    type_out(entry, (enters ? typed.folder / row->name / "" : typed.folder / row->name).string());
    entry.chosen = 0;
  } else if (row != nullptr && opens) {
    choose(ui, typed.folder / row->name);
  } else if (opens ? fs::exists(typed.whole(), none) : !typed.name.empty()) {
    choose(ui, typed.whole());
  }
}

/// Returns the first row that can be chosen; 0 if none can.
int first_choice(std::span<const FolderEntry> found) {
  const auto usable = std::ranges::find_if(
      found, [](const FolderEntry& one) { return one.folder || !one.what.empty(); });
  return usable == found.end() ? 0 : static_cast<int>(usable - found.begin());
}

void draw_browser_status(const FolderList& list, const TypedPath& typed, bool saves) {
  std::error_code none;
  if (!list.error.empty()) {
    ImGui::TextDisabled("%s: %s", typed.folder.c_str(), list.error.c_str());
  } else if (list.reading && list.entries.empty()) {
    ImGui::TextDisabled("Reading the folder ...");
  } else if (saves && !typed.name.empty() && fs::exists(typed.whole(), none)) {
    ImGui::TextDisabled("%s exists and will be replaced", typed.name.c_str());
  } else {
    ImGui::TextDisabled("Tab completes \u00b7 Up, Down choose \u00b7 Enter %s \u00b7 Esc closes",
                        saves ? "saves" : "opens");
  }
}

/// A size and a rate of a camera.
struct SourceChoice {
  std::string address, name, mode;
};

std::vector<SourceChoice> source_choices(std::span<const CameraDevice> cameras) {
  std::vector<SourceChoice> choices;
  for (const CameraDevice& camera : cameras) {
    const std::string address = fmt::format("camera:{}", camera.number);
    if (camera.modes.empty()) choices.push_back({address, camera.name, "default size"});
    for (const CameraMode& mode : camera.modes) {
      const std::string size = fmt::format("{}x{}", mode.size.width, mode.size.height);
      const std::string rate = mode.rate_hz > 0 ? fmt::format("{:g}", mode.rate_hz) : "";
      choices.push_back({fmt::format("{},{}{}{}", address, size, rate.empty() ? "" : ",", rate),
                         camera.name,
                         rate.empty() ? size : fmt::format("{}, {} Hz", size, rate)});
    }
  }
  return choices;
}

void draw_source(const SourceChoice& choice, float width, float scale) {
  const RowWriter write{ImGui::GetCursorScreenPos(), scale};
  const float gap = 8 * scale;
  write(gap, Role::text, choice.name, 0.45F * width - gap);
  write(0.45F * width, Role::text, choice.mode, 0.25F * width - gap);
  write(0.7F * width, Role::text_dim, choice.address, 0.3F * width - gap);
}

}  // namespace

void palette_overlay(const PanelContext& ui, const Rectangle& window) {
  const float s = ui.scale;
  ListEntry& entry = ui.views.palette;
  if (!entry.open && !ui.state.view.palette->empty()) type_out(entry, *ui.state.view.palette + " ");
  entry.open = true;
  const OverlayScope overlay("palette", window, 640 * s, s);
  const bool entered =
      text_field(entry, "Part of a command's name, or a whole command, e.g. frame 40");
  const std::string text = entry.text.data();
  // For a complete command only its own usage is shown.
  const auto call = match_line(text);
  const std::vector<Action> found = call && !call->arguments.empty()
                                        ? std::vector<Action>{*call->action}
                                        : find_actions(text, ui.state);
  entry.chosen = moved_choice(entry.chosen, 0, static_cast<int>(found.size()));
  const auto draw_one = [s](const Action& action, float width) { draw_command(action, width, s); };
  const int clicked = draw_rows<Action>(found, entry.chosen, kCommands, s, draw_one);
  if (clicked >= 0) accept_command(entry, &found[clicked], ui.commands);
  if (entered) accept_command(entry, found.empty() ? nullptr : &found[entry.chosen], ui.commands);
  if (found.empty()) ImGui::TextUnformatted("No command matches. F1 lists the keys");
}

void browser_overlay(const PanelContext& ui, const Rectangle& window) {
  const float s = ui.scale;
  const Browse& browse = *ui.state.view.browse;
  ListEntry& entry = ui.views.browser;
  const bool saves = browse.action != "open";
  if (!entry.open) {
    type_out(entry, browse.text);
    entry.chosen = saves ? -1 : 0;
  }
  entry.open = true;
  const TypedPath typed = typed_path(entry.text.data());
  if (ui.lister != nullptr) entry.listed = ui.lister->list(typed.folder);
  const std::vector<FolderEntry> found = matching(entry.listed.entries, typed.name);

  const OverlayScope overlay("browser", window, 760 * s, s);
  heading(action_named(browse.action).title.c_str());
  const bool entered = text_field(entry, "", ImGuiInputTextFlags_CallbackCompletion);
  folder_buttons(ui, entry);
  entry.chosen = moved_choice(entry.chosen, saves ? -1 : 0, static_cast<int>(found.size()));
  // By default the top row, which may be a file that cannot be opened.
  const bool named = !found.empty() && found.front().name == typed.name;
  if (!saves && !named && entry.chosen == 0) entry.chosen = first_choice(found);
  const auto draw_one = [s, saves](const FolderEntry& file, float width) {
    draw_file(file, !saves && !file.folder && file.what.empty(), width, s);
  };
  const int clicked = draw_rows<FolderEntry>(found, entry.chosen, kFiles, s, draw_one);
  const int row = clicked >= 0 ? clicked : entry.chosen;
  const bool exists = row >= 0 && row < static_cast<int>(found.size());
  if (clicked >= 0 || entered)
    accept_file(ui, entry, exists ? &found[static_cast<std::size_t>(row)] : nullptr);
  draw_browser_status(entry.listed, typed, saves);
}

void sources_overlay(const PanelContext& ui, const Rectangle& window) {
  const float s = ui.scale;
  ListEntry& entry = ui.views.sources;
  const std::vector<SourceChoice> found = source_choices(*ui.state.view.sources);
  const OverlayScope overlay("sources", window, 640 * s, s);
  heading(action_named("live").title.c_str());
  const bool entered =
      text_field(entry, "Address of a stream: rtsp://, http:// or udp://, or of a camera");
  entry.chosen = moved_choice(entry.chosen, 0, static_cast<int>(found.size()));
  const auto draw_one = [s](const SourceChoice& one, float width) { draw_source(one, width, s); };
  const int clicked = draw_rows<SourceChoice>(found, entry.chosen, kModes, s, draw_one);
  const std::string typed = entry.text.data();
  const int row = clicked >= 0 ? clicked : typed.empty() && entered ? entry.chosen : -1;
  if (row >= 0 && row < static_cast<int>(found.size()))
    push(ui.commands, RunAction{"live " + found[static_cast<std::size_t>(row)].address});
  else if (entered && !typed.empty())
    push(ui.commands, RunAction{"live " + as_argument(typed)});
  if (found.empty()) ImGui::TextDisabled("Found no camera that this user may open");
  ImGui::TextDisabled("Up, Down choose a camera \u00b7 Enter opens \u00b7 Esc closes");
}

}  // namespace gpo
