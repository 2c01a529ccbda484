// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Menu bar, banners, context menu, status line, and the lines between the parts of the window.
#include "ui/panels/panels.h"
#include "ui/workbench/work/live_host.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

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

/// Actions before which menus have a separator.
constexpr std::string_view kGroups[] = {"save-session",
                                        "save-picture",
                                        "metric",
                                        "quit",
                                        "select track",
                                        "exclude",
                                        "put-cube",
                                        "residuals",
                                        "view scene",
                                        "previous",
                                        "window-start",
                                        "bookmark",
                                        "ransac",
                                        "compute",
                                        "tour"};

/// A submenu takes the place of the first of its actions.
void draw_menu(const std::string& menu, const PanelContext& ui) {
  std::set<std::string> drawn;
  for (const Action& action : all_actions(ui.state)) {
    if (action.menu != menu) continue;
    const bool at_its_place = action.submenu.empty() || !drawn.contains(action.submenu);
    if (at_its_place && std::ranges::count(kGroups, action.name) > 0) ImGui::Separator();
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

void banner(const PanelContext& ui, const Rectangle& place, Role role, auto&& draw) {
  const std::uint32_t rgb = mixed_rgb(color_of(Role::raised), color_of(role), 0.18);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_color(rgb));
  ImGui::PushStyleColor(ImGuiCol_Button, imgui_color(Role::active));
  {
    const float padding = std::round((place.height - ImGui::GetTextLineHeight()) / 2);
    const PanelScope scope("banner", place, {12 * ui.scale, padding});
    draw();
  }
  ImGui::PopStyleColor(2);
}

void action_button(const PanelContext& ui, const char* name) {
  const Action& action = action_named(name);
  if (ImGui::SmallButton(action.title.c_str())) push(ui.commands, RunAction{action.name});
  tooltip(action.tooltip);
  ImGui::SameLine(0, 6 * ui.scale);
}

void method_button(const PanelContext& ui) {
  if (ImGui::SmallButton("Another method")) ImGui::OpenPopup("methods");
  tooltip("Initializes the same window by another method");
  if (!ImGui::BeginPopup("methods")) return;
  for (const MethodChoice& method : ui.state.methods.all()) {
    const bool now = method == ui.state.document.settings.options.method;
    if (ImGui::MenuItem(method.row().title.c_str(), nullptr, now))
      push(ui.commands, RunAction{"method " + method.key()});
    tooltip(method.row().help);
  }
  ImGui::EndPopup();
}

Role role_of_live(const LiveView& live) {
  if (!live.capture.message.empty()) return Role::warning;
  return live.answer && live.answer->missing.empty() ? Role::good : Role::accent;
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
    if (calibration_may_help(ui) && !has_failed(ui))
      offer("calibrate", "No calibration: the field of view is guessed", ui.commands);
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
    const std::string& message = ui.state.messages.text;
    const Severity severity = message.empty() ? Severity::note : ui.state.messages.severity;
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

bool has_failed(const PanelInput& input) {
  const Inspection* inspection = input.inspection();
  return input.state.document.recording && inspection != nullptr && inspection->initialization &&
         !inspection->initialization->ok;
}

void failure_banner(const PanelContext& ui, const Rectangle& place) {
  banner(ui, place, Role::bad, [&] {
    const float s = ui.scale;
    const Recording& recording = *ui.state.document.recording;
    const bool guessed = recording.camera_source == CameraSource::guess && recording.images;
    const bool another_start = ui.state.frame_count() > ui.state.document.settings.frames;
    float buttons = 150 * s + (another_start ? 110 * s : 0) + (guessed ? 190 * s : 0);
    const std::string why = "Not initialized: " + ui.inspection()->initialization->reason;
    const float room = std::max(60 * s, place.width - 24 * s - buttons);
    clipped_text(why, room, color_of(Role::text));
    ImGui::SameLine(0, 12 * s);
    if (another_start) action_button(ui, "find-start");
    if (guessed) action_button(ui, "calibrate");
    method_button(ui);
  });
}

void live_banner(const PanelContext& ui, const Rectangle& place) {
  const LiveView& live = *ui.state.live;
  banner(ui, place, role_of_live(live), [&] {
    const float s = ui.scale;
    const std::string counts = counts_text(live);
    const float counts_width = ImGui::CalcTextSize(counts.c_str()).x;
    const float button_width = 76 * s;
    const float room = place.width - 24 * s - button_width - 12 * s;
    clipped_text("Live: " + progress_text(live),
                 std::max(60 * s, room - counts_width - 12 * s),
                 color_of(Role::text));
    if (room - counts_width > 160 * s) {
      ImGui::SameLine(12 * s + room - counts_width);
      colored_text(Role::text_dim, counts);
    }
    ImGui::SameLine(place.width - 12 * s - button_width);
    if (ImGui::SmallButton("Freeze")) push(ui.commands, RunAction{"freeze"});
    tooltip("Space. " + action_named("freeze").tooltip);
  });
}

}  // namespace gpo
