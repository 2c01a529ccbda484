// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/facts/uncertainty_facts.h"
#include "ui/panels/panels.h"
#include "ui/panels/timeline/scan_strip.h"
#include "ui/panels/timeline/time_axis.h"
#include "ui/panels/timeline/timeline_bars.h"
#include "ui/panels/widgets.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/time_span.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

enum class Icon { first, back, play, pause, on, last };

void draw_triangle(ImDrawList& list, ImVec2 center, float size, bool to_left, ImU32 color) {
  const float tip = to_left ? -size : size;
  list.AddTriangleFilled({center.x - tip * 0.8F, center.y - size},
                         {center.x - tip * 0.8F, center.y + size},
                         {center.x + tip * 0.9F, center.y},
                         color);
}

void draw_bar(ImDrawList& list, ImVec2 center, float half_width, float half_height, ImU32 color) {
  list.AddRectFilled({std::round(center.x - half_width), std::round(center.y - half_height)},
                     {std::round(center.x + half_width), std::round(center.y + half_height)},
                     color);
}

void draw_icon(ImDrawList& list, Icon icon, ImVec2 c, float size, ImU32 color) {
  switch (icon) {
    case Icon::first:
      draw_bar(list, {c.x - size, c.y}, size * 0.2F, size, color);
      return draw_triangle(list, {c.x + size * 0.25F, c.y}, size, true, color);
    case Icon::last:
      draw_bar(list, {c.x + size, c.y}, size * 0.2F, size, color);
      return draw_triangle(list, {c.x - size * 0.25F, c.y}, size, false, color);
    case Icon::back:
      return draw_triangle(list, c, size * 0.85F, true, color);
    case Icon::on:
      return draw_triangle(list, c, size * 0.85F, false, color);
    case Icon::play:
      return draw_triangle(list, c, size * 1.2F, false, color);
    case Icon::pause:
      draw_bar(list, {c.x - size * 0.5F, c.y}, size * 0.3F, size * 1.1F, color);
      return draw_bar(list, {c.x + size * 0.5F, c.y}, size * 0.3F, size * 1.1F, color);
  }
}

void icon_button(Icon icon, const char* name, float side, const PanelInput& input, Commands& out) {
  const Action& action = action_named(name);
  ImGui::PushID(name);
  ImGui::BeginDisabled(!enabled(action, input.state));
  if (ImGui::Button("##icon", {side, side})) push(out, RunAction{name});
  ImGui::EndDisabled();
  const ImVec2 from = ImGui::GetItemRectMin();
  const ImVec2 to = ImGui::GetItemRectMax();
  const ImU32 color = imgui_color(enabled(action, input.state) ? Role::text : Role::text_dim);
  draw_icon(*ImGui::GetWindowDrawList(),
            icon,
            {(from.x + to.x) / 2, (from.y + to.y) / 2},
            side * 0.2F,
            color);
  tooltip(action.title + " (" + action.shortcuts.front().label + ")");
  ImGui::PopID();
}

void draw_window_ends(ImDrawList& list,
                      const Settings& settings,
                      const TimeAxis& axis,
                      float top,
                      float bottom,
                      float scale) {
  const float left = slot_begin(axis, settings.start);
  const float right = slot_begin(axis, std::min(axis.frames, settings.start + settings.frames));
  const ImU32 color = imgui_color(Role::accent);
  const float line = std::max(1.0F, std::round(2 * scale));
  const float foot = std::round(6 * scale);
  list.AddRectFilled({left, top}, {right, bottom}, imgui_color(Role::accent, 0.14));
  list.AddRectFilled({left, top}, {left + line, bottom}, color);
  list.AddRectFilled({right - line, top}, {right, bottom}, color);
  for (const float y : {top, bottom - line}) {
    list.AddRectFilled({left, y}, {left + foot, y + line}, color);
    list.AddRectFilled({right - foot, y}, {right, y + line}, color);
  }
}

void draw_cursor(ImDrawList& list, float x, float top, float bottom, float scale) {
  const float half = std::max(1.0F, std::round(scale));
  const ImU32 color = imgui_color(Role::text);
  x = std::round(x);
  list.AddRectFilled({x - half, top}, {x + half, bottom}, color);
  const float head = 5 * scale;
  list.AddTriangleFilled(
      {x - head, top - head}, {x + head, top - head}, {x, top + head * 0.4F}, color);
}

/// Of the bookmark at a frame, as a line; empty where there is none.
std::string note_at(const std::vector<Bookmark>& bookmarks, int frame) {
  const auto found = std::ranges::find(bookmarks, frame, &Bookmark::frame);
  if (found == bookmarks.end()) return "";
  return (found->note.empty() ? "bookmark" : found->note) + "\n";
}

/// Either end of the window can be taken hold of and moved.
void drag_window_ends(const PanelInput& input,
                      const TimeAxis& axis,
                      const Rectangle& bar,
                      Commands& commands) {
  const Settings& settings = input.state.document.settings;
  const float reach = 5 * input.scale;
  const float x = ImGui::GetIO().MousePos.x;
  const auto handle = [&](const char* name, int frame, auto moved) {
    const float at = slot_begin(axis, frame);
    if (at < bar.x || at > bar.right()) return;
    ImGui::SetCursorScreenPos({at - reach, bar.y});
    hit_area(name, {2 * reach, bar.height});
    if (ImGui::IsItemHovered() || ImGui::IsItemActive())
      ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    tooltip("Drag: moves this end of the window");
    if (ImGui::IsItemActive() && ImGui::GetIO().MouseDelta.x != 0)
      push(commands, ChangeSettings{moved(), true});
  };
  const int count = axis.frames;
  handle(
      "start", settings.start, [&] { return start_window_at(settings, frame_at(axis, x), count); });
  handle("end", std::min(count, settings.start + settings.frames), [&] {
    return end_window_at(settings, frame_at(axis, x), count);
  });
}

void zoom_time(const TimeAxis& axis, Commands& commands) {
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) push(commands, RunAction{"time-line"});
  if (io.MouseWheel == 0) return;
  const double share = (io.MousePos.x - axis.left) / (axis.right - axis.left);
  const TimeSpan span = zoomed(axis.span, axis.frames, share, std::pow(0.8, io.MouseWheel));
  push(commands,
       RunAction{span.count > 0 ? fmt::format("time-line {} {}", span.first, span.count)
                                : "time-line all"});
}

/// Where the shown part is in the whole recording.
void draw_overview(ImDrawList& list, const TimeAxis& axis, float bottom, float scale) {
  if (axis.span.count == 0) return;
  const TimeAxis whole{axis.left, axis.right, axis.frames};
  const float top = bottom - std::round(3 * scale);
  const float left = slot_begin(whole, axis.span.first);
  const float right = slot_begin(whole, axis.span.first + axis.span.count);
  list.AddRectFilled({axis.left, top}, {axis.right, bottom}, imgui_color(Role::hovered));
  list.AddRectFilled(
      {left, top}, {std::max(right, left + 3 * scale), bottom}, imgui_color(Role::accent));
}

void draw_axis(const PanelInput& input, const Rectangle& bar, Commands& commands) {
  const WorkbenchState& state = input.state;
  const TimeAxis axis{
      bar.x, bar.right(), state.frame_count(), holding(state.view.time_span, state.view.frame)};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({bar.x, bar.y}, {bar.right(), bar.bottom()}, imgui_color(Role::raised));
  if (axis.frames < 1) return;
  const Inspection* shown =
      input.inspection() && input.inspection()->window ? input.inspection() : nullptr;
  drag_window_ends(input, axis, bar, commands);
  ImGui::SetCursorScreenPos({bar.x, bar.y});
  hit_area("axis", {bar.width, bar.height});
  if (ImGui::IsItemHovered()) zoom_time(axis, commands);
  if (ImGui::IsItemActive()) {
    // The second press of a double click is not meant for the frame that then is under it.
    if (ImGui::GetIO().MouseClickedLastCount[ImGuiMouseButton_Left] < 2)
      push(commands, GoToFrame{frame_at(axis, ImGui::GetIO().MousePos.x)});
  } else if (ImGui::IsItemHovered()) {
    const float x = ImGui::GetIO().MousePos.x;
    const int frame = frame_at(axis, x);
    // Above the bars, which it would hide; as far right as the mouse, so never beyond the window.
    const float share = x / ImGui::GetIO().DisplaySize.x;
    ImGui::SetNextWindowPos({x, bar.y - 8 * input.scale}, 0, {share, 1});
    const std::string text = shown ? bar_text(*shown, frame) : fmt::format("frame {}", frame);
    tooltip(note_at(state.document.bookmarks, frame) + text);
  }
  list.PushClipRect({bar.x, bar.y - 8 * input.scale}, {bar.right(), bar.bottom()}, true);
  draw_window_ends(list, state.document.settings, axis, bar.y, bar.bottom(), input.scale);
  if (shown) {
    draw_tracks(list, *shown, axis, bar.y + 3 * input.scale, bar.bottom());
    draw_motion(list, *shown, axis, bar.y + 4 * input.scale, bar.bottom() - 2 * input.scale);
    draw_verdict_signs(list, *shown, axis, bar.bottom() - 9 * input.scale, input.scale);
    draw_scale_mark(list, *shown, axis, bar.y, bar.bottom(), input.scale);
  }
  draw_bookmarks(list, state.document.bookmarks, axis, bar.y, input.scale);
  draw_cursor(list, slot_middle(axis, state.view.frame), bar.y, bar.bottom(), input.scale);
  draw_overview(list, axis, bar.bottom(), input.scale);
  list.PopClipRect();
}

/// How playing goes: its speed and whether it repeats the window.
void draw_playing(const PanelInput& input, Commands& commands) {
  const WorkbenchState& state = input.state;
  const float gap = 6 * input.scale;
  ImGui::PushFont(font(Font::small));
  ImGui::SameLine(0, gap);
  if (ImGui::SmallButton(fmt::format("{:g}\u00d7", state.view.speed).c_str()))
    push(commands, RunAction{state.view.speed >= 8 ? "speed 0.125" : "faster"});
  tooltip("Speed of playing; click: twice as fast (+), from 8\u00d7 on again at 1/8. - halves it");
  ImGui::SameLine(0, gap);
  ImGui::PushStyleColor(ImGuiCol_Text,
                        imgui_color(state.view.loop ? Role::accent : Role::text_dim));
  if (ImGui::SmallButton("loop")) push(commands, RunAction{"loop"});
  ImGui::PopStyleColor();
  tooltip("Playing repeats the window (L)");
  ImGui::PopFont();
}

/// "frame 29 / 59" over "0.967 s": counted from 0, as everywhere.
void draw_numbers(const PanelInput& input, float left, float top, Commands& commands) {
  const WorkbenchState& state = input.state;
  if (!state.document.recording) return;
  const auto& times = state.document.recording->timestamps_ns;
  const double seconds = static_cast<double>(times[state.view.frame] - times.front()) * 1e-9;
  ImGui::SetCursorScreenPos({left, top});
  ImGui::TextUnformatted(
      fmt::format("frame {} / {}", state.view.frame, state.frame_count() - 1).c_str());
  ImGui::SetCursorScreenPos({left, top + ImGui::GetTextLineHeightWithSpacing()});
  const int start = state.document.settings.start;
  colored_text(Role::text_dim, fmt::format("{:.3f} s", seconds));
  tooltip(fmt::format(
      "The window spans frames {} to {}", start, start + state.document.settings.frames - 1));
  draw_playing(input, commands);
}

float width_of_longest_time(const PanelInput& input) {
  if (!input.state.document.recording) return 0;
  const auto& times = input.state.document.recording->timestamps_ns;
  const double seconds = static_cast<double>(times.back() - times.front()) * 1e-9;
  return ImGui::CalcTextSize(fmt::format("{:.3f} s", seconds).c_str()).x;
}

/// Scan, axis and legend, one above the other; nothing where the window leaves them no room.
void draw_over_time(const PanelInput& input, Rectangle bar, bool legend, Commands& commands) {
  if (bar.empty()) return;
  const float s = input.scale;
  if (input.state.view.toggles.scan) {
    const float strip = std::round(kScanHeight * s);
    scan_strip(input, {bar.x, bar.y - std::round(8 * s), bar.width, strip}, commands);
    bar = {bar.x, bar.y + strip, bar.width, bar.height - strip};
  }
  draw_axis(input, bar, commands);
  if (legend)
    draw_verdict_legend(
        *ImGui::GetWindowDrawList(), *input.inspection(), bar.x, bar.bottom() + 4 * s, s);
}

}  // namespace

void timeline_panel(const PanelInput& input, const Rectangle& place, Commands& commands) {
  const float s = input.scale;
  const PanelScope panel("timeline", place, {12 * s, 12 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {4 * s, 4 * s});
  const float side = std::round(std::min(30 * s, place.height - 16 * s));
  ImGui::SetCursorPosY(std::round((place.height - side) / 2));
  const Icon play = input.state.view.playing ? Icon::pause : Icon::play;
  const std::array<std::pair<Icon, const char*>, 5> buttons = {{{Icon::first, "first"},
                                                                {Icon::back, "previous"},
                                                                {play, "play"},
                                                                {Icon::on, "next"},
                                                                {Icon::last, "last"}}};
  for (const auto& [icon, name] : buttons) {
    icon_button(icon, name, side, input, commands);
    ImGui::SameLine();
  }
  const float numbers = std::round(std::max(136 * s, width_of_longest_time(input) + 88 * s));
  const float left = place.x + ImGui::GetCursorPosX() + 10 * s;
  const float room = place.right() - 24 * s - left;
  const bool numbered = room - numbers > 80 * s;  // where only one of both fits, it is the axis
  const Inspection* shown = input.inspection();
  const bool failed = shown != nullptr && shown->initialization && !shown->initialization->ok;
  const bool legend = shown != nullptr && (failed || !shown->growth.empty()) &&
                      place.height >= 70 * s && place.width >= 700 * s;
  draw_over_time(input,
                 {left,
                  place.y + std::round(12 * s),
                  numbered ? room - numbers : room,
                  place.height - std::round(legend ? 34 * s : 22 * s)},
                 legend,
                 commands);
  if (numbered)
    draw_numbers(input,
                 place.right() - numbers - 8 * s,
                 place.y + std::round(place.height / 2 - ImGui::GetTextLineHeight() - 2 * s),
                 commands);
  ImGui::PopStyleVar();
}

}  // namespace gpo
