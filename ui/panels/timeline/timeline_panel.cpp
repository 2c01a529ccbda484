// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/studies.h"
#include "engine/recording/companions/companion_files.h"
#include "ui/context/gui.h"
#include "ui/panels/panels.h"
#include "ui/panels/timeline/timeline_bars.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

enum class Icon { first, back, play, pause, on, last };

void draw_icon(ImDrawList& list, Icon icon, ImVec2 c, float size, ImU32 color) {
  /// `tip`: half its width, negative to the left.
  const auto triangle = [&](float x, float tip) {
    const float left = c.x + x * size, half = std::abs(tip) * size;
    const float end = left + tip * size * 0.9F, back = left - tip * size * 0.8F;
    list.AddTriangleFilled({back, c.y - half}, {back, c.y + half}, {end, c.y}, color);
  };
  const auto bar = [&](float x, float half_width, float half_height) {
    const float middle = c.x + x * size;
    list.AddRectFilled(
        {std::round(middle - half_width * size), std::round(c.y - half_height * size)},
        {std::round(middle + half_width * size), std::round(c.y + half_height * size)},
        color);
  };
  if (icon == Icon::first || icon == Icon::last) {
    const float side = icon == Icon::first ? -1 : 1;
    bar(side, 0.2F, 1);
    triangle(-0.25F * side, side);
  } else if (icon == Icon::pause) {
    bar(-0.5F, 0.3F, 1.1F);
    bar(0.5F, 0.3F, 1.1F);
  } else {
    triangle(0, icon == Icon::back ? -0.85F : icon == Icon::on ? 0.85F : 1.2F);
  }
}

void icon_button(const PanelContext& ui, Icon icon, const char* name, float side) {
  const Action& action = action_named(name);
  const bool usable = enabled(action, ui.state);
  ImGui::PushID(name);
  ImGui::BeginDisabled(!usable);
  if (ImGui::Button("##icon", {side, side})) push(ui.commands, RunAction{name});
  ImGui::EndDisabled();
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  const ImVec2 middle((from.x + to.x) / 2, (from.y + to.y) / 2);
  const ImU32 color = imgui_color(usable ? Role::text : Role::text_dim);
  draw_icon(*ImGui::GetWindowDrawList(), icon, middle, side * 0.2F, color);
  tooltip(action.title + " (" + action.shortcuts.front().label + ")");
  ImGui::PopID();
}

void draw_window_ends(const BarArea& area, const Settings& settings) {
  const auto& [list, axis, top, bottom, scale] = area;
  const float left = axis.slot_begin(settings.start);
  const float right = axis.slot_begin(std::min(axis.frames, settings.start + settings.frames));
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

void draw_cursor(const BarArea& area, int frame) {
  const float half = std::max(1.0F, std::round(area.scale)), head = 5 * area.scale;
  const ImU32 color = imgui_color(Role::text);
  const float x = std::round(area.axis.slot_middle(frame)), top = area.top;
  area.list.AddRectFilled({x - half, top}, {x + half, area.bottom}, color);
  area.list.AddTriangleFilled(
      {x - head, top - head}, {x + head, top - head}, {x, top + head * 0.4F}, color);
}

/// Returns the note of the bookmark and the jumps of the truth at a frame, each as a line.
std::string notes_at(const PanelContext& ui, int frame) {
  const auto& bookmarks = ui.state.document.bookmarks;
  const auto found = std::ranges::find(bookmarks, frame, &Bookmark::frame);
  std::string text;
  if (found != bookmarks.end()) text = (found->note.empty() ? "bookmark" : found->note) + "\n";
  for (const TruthJump& jump : shown_jumps(ui.state, ui.inspection())) {
    const Recording& recording = *ui.state.document.recording;
    if (frame_after(jump, recording) == frame)
      text += text_of(jump, recording.timestamps_ns.front()) + "\n";
  }
  return text;
}

void drag_window_ends(const PanelContext& ui, const TimeAxis& axis, const Rectangle& bar) {
  const Settings& settings = ui.state.document.settings;
  const float reach = 5 * ui.scale;
  const int count = axis.frames, under = axis.frame_at(ImGui::GetIO().MousePos.x);
  const auto handle = [&](const char* name, int frame, auto moved) {
    const float at = axis.slot_begin(frame);
    if (at < bar.x || at > bar.right()) return;
    hit_area_at(name, {at - reach, bar.y, 2 * reach, bar.height});
    if (ImGui::IsItemHovered() || ImGui::IsItemActive())
      ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    tooltip("Drag to move this end of the window");
    if (ImGui::IsItemActive() && ImGui::GetIO().MouseDelta.x != 0)
      push(ui.commands, ChangeSettings{moved(settings, under, count), current_drag()});
  };
  handle("start", settings.start, start_window_at);
  handle("end", std::min(count, settings.start + settings.frames), end_window_at);
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

void draw_overview(const BarArea& area) {
  const TimeAxis& axis = area.axis;
  if (axis.span.count == 0) return;
  const TimeAxis whole{axis.left, axis.right, axis.frames};
  const float top = area.bottom - std::round(3 * area.scale);
  const float left = whole.slot_begin(axis.span.first);
  const float right = whole.slot_begin(axis.span.first + axis.span.count);
  area.list.AddRectFilled({axis.left, top}, {axis.right, area.bottom}, imgui_color(Role::hovered));
  area.list.AddRectFilled({left, top},
                          {std::max(right, left + 3 * area.scale), area.bottom},
                          imgui_color(Role::accent));
}

void handle_mouse(const PanelContext& ui, const TimeAxis& axis, float top) {
  const float x = ImGui::GetIO().MousePos.x;
  const int frame = axis.frame_at(x);
  if (ImGui::IsItemHovered()) zoom_time(axis, ui.commands);
  if (ImGui::IsItemActive()) {
    // The second press of a double click resets the zoom; it must not go to a frame.
    if (ImGui::GetIO().MouseClickedLastCount[ImGuiMouseButton_Left] < 2)
      push(ui.commands, GoToFrame{frame});
  } else if (ImGui::IsItemHovered()) {
    // Above the bars, and shifted so that it never leaves the window.
    const float share = x / ImGui::GetIO().DisplaySize.x;
    ImGui::SetNextWindowPos({x, top - 8 * ui.scale}, 0, {share, 1});
    const Inspection* shown = ui.inspection();
    const std::string text =
        shown && shown->window ? bar_text(*shown, frame) : fmt::format("frame {}", frame);
    tooltip(notes_at(ui, frame) + text);
  }
}

void draw_axis(const PanelContext& ui, const TimeAxis& axis, const Rectangle& bar) {
  const WorkbenchState& state = ui.state;
  const float s = ui.scale;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({bar.x, bar.y}, {bar.right(), bar.bottom()}, imgui_color(Role::raised));
  if (axis.frames < 1) return;
  drag_window_ends(ui, axis, bar);
  hit_area_at("axis", bar);
  if (right_clicked(s)) {
    const int frame = axis.frame_at(ImGui::GetIO().MousePos.x);
    open_context_menu(
        ui,
        {{.kind = ContextKind::frame, .title = fmt::format("Frame {}", frame), .frame = frame}});
  }
  handle_mouse(ui, axis, bar.y);
  list.PushClipRect({bar.x, bar.y - 8 * s}, {bar.right(), bar.bottom()}, true);
  const BarArea area{list, axis, bar.y, bar.bottom(), s};
  draw_window_ends(area, state.document.settings);
  if (const Inspection* shown = ui.inspection(); shown && shown->window) {
    draw_tracks({list, axis, bar.y + 3 * s, bar.bottom(), s}, *shown);
    draw_motion({list, axis, bar.y + 4 * s, bar.bottom() - 2 * s, s}, *shown);
    draw_verdict_signs(area, *shown);
    draw_scale_mark(area, *shown);
  }
  if (state.document.recording)
    draw_jumps(area, *state.document.recording, shown_jumps(state, ui.inspection()));
  draw_bookmarks(area, state.document.bookmarks);
  draw_cursor(area, state.view.frame);
  draw_overview(area);
  list.PopClipRect();
}

void draw_playback(const PanelContext& ui) {
  const ViewState& view = ui.state.view;
  const float gap = 6 * ui.scale;
  ImGui::PushFont(font(Font::small));
  ImGui::SameLine(0, gap);
  if (ImGui::SmallButton(fmt::format("{:g}\u00d7", view.speed).c_str()))
    push(ui.commands, RunAction{view.speed >= 8 ? "speed 0.125" : "faster"});
  tooltip("Playback speed. Click or + to double it (after 8\u00d7 comes 1/8), - to halve it");
  ImGui::SameLine(0, gap);
  ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(view.loop ? Role::accent : Role::text_dim));
  if (ImGui::SmallButton("loop")) push(ui.commands, RunAction{"loop"});
  ImGui::PopStyleColor();
  tooltip("Repeats the window during playback (L)");
  ImGui::PopFont();
}

/// Returns the time since the first frame, e.g. "0.967 s".
std::string time_text(const Recording& recording, int frame) {
  const auto& times = recording.timestamps_ns;
  return fmt::format("{:.3f} s", static_cast<double>(times[frame] - times.front()) * 1e-9);
}

/// Draws "frame 29 / 59" above "0.967 s"; frames count from 0.
void draw_numbers(const PanelContext& ui, float left, float top) {
  const WorkbenchState& state = ui.state;
  if (!state.document.recording) return;
  ImGui::SetCursorScreenPos({left, top});
  ImGui::TextUnformatted(
      fmt::format("frame {} / {}", state.view.frame, state.frame_count() - 1).c_str());
  ImGui::SetCursorScreenPos({left, top + ImGui::GetTextLineHeightWithSpacing()});
  const int start = state.document.settings.start;
  colored_text(Role::text_dim, time_text(*state.document.recording, state.view.frame));
  tooltip(fmt::format(
      "The window spans frames {} to {}", start, start + state.document.settings.frames - 1));
  draw_playback(ui);
}

constexpr float kRulerHeight = 14, kLabelWidth = 46;  // at scale 1 [px]

/// Names a strip in the gutter at its left.
void label_strip(const PanelContext& ui, const char* name, const Rectangle& strip) {
  const Vector2d size = text_size(Font::small, name);
  write_text(*ImGui::GetWindowDrawList(),
             Font::small,
             {strip.x - 6 * ui.scale - size.x(), strip.y + (strip.height - size.y()) / 2},
             name,
             color_of(Role::text_dim));
}

/// Texts beside and below the strips.
struct StripTexts {
  bool labels, legend;
  float gutter_px;  ///< room at the right
};

void draw_over_time(const PanelContext& ui, Rectangle bar, const StripTexts& texts) {
  if (bar.empty()) return;
  const float s = ui.scale;
  const WorkbenchState& state = ui.state;
  const TimeAxis axis{
      bar.x, bar.right(), state.frame_count(), holding(state.view.time_span, state.view.frame)};
  if (state.view.toggles.scan) {
    const Rectangle starts{
        bar.x, bar.y - std::round(8 * s), bar.width, std::round(kScanHeight * s)};
    if (texts.labels) label_strip(ui, "starts", starts);
    scan_strip(ui, axis, starts, texts.gutter_px);
    bar.y += starts.height;
    bar.height -= starts.height;
  }
  const float ruler = std::round(kRulerHeight * s);
  bar.height = std::max(1.0F, bar.height - ruler);
  draw_axis(ui, axis, bar);
  const Rectangle below{bar.x, bar.bottom() + std::round(2 * s), bar.width, ruler};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (const Recording* recording = state.document.recording.get())
    draw_ruler({list, axis, below.y, below.bottom(), s}, recording->timestamps_ns);
  if (texts.labels) {
    label_strip(ui, "tracks", bar);
    label_strip(ui, "time", below);
  }
  if (!texts.legend) return;
  const float top = below.bottom() + 2 * s;
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowSize().x - 8 * s;
  draw_verdict_legend({list, {}, top, top, s}, *ui.inspection(), bar.x, right);
}

}  // namespace

std::string bar_text(const Inspection& inspection, int frame) {
  const Window& window = *inspection.window;
  const int in_window = frame - window.start;
  std::string text = fmt::format("frame {}", frame);
  if (in_window < 0 || in_window >= window.frame_count()) return text;
  text += ": " + counted(window.inlier_count(in_window), "inlier");
  if (const int lost = lost_count(window, in_window); lost > 0)
    text += fmt::format(", {} lost", lost);
  if (in_window < static_cast<int>(inspection.motion.size())) {
    const FrameMotion& motion = inspection.motion[in_window];
    text += fmt::format("\n{}angular rate {:.0f}\u00b0/s",
                        std::isfinite(motion.parallax_px)
                            ? fmt::format("parallax {:.1f} px, ", motion.parallax_px)
                            : "",
                        motion.rotation_rate_deg_s);
  }
  if (in_window == 0) return text + ". Reference frame: the window starts here";
  const std::vector<Verdict>& growth = shown_growth(inspection);
  if (in_window > static_cast<int>(growth.size())) return text;
  const Verdict& verdict = growth[in_window - 1];
  text += fmt::format("\nwindow of {} frames, {} to {}: ", in_window + 1, window.start, frame);
  text += verdict_text(verdict) + "\n" + verdict.reason;
  const bool whole = in_window + 1 == window.frame_count();
  if (whole && inspection.initialization && inspection.initialization->verdict) return text;
  text += "\n(estimated by GPO with the given rotations; ";
  text += inspection.comparable_growth.empty() ? "image regions are not compared)"
                                               : "at least as wide as the whole window's)";
  return text;
}

void timeline_panel(const PanelContext& ui, const Rectangle& place) {
  const float s = ui.scale;
  const PanelScope scope("timeline", place, {12 * s, 12 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {4 * s, 4 * s});
  const float side = std::round(std::min(30 * s, place.height - 16 * s));
  ImGui::SetCursorPosY(std::round((place.height - side) / 2));
  const Icon play = ui.state.view.playing ? Icon::pause : Icon::play;
  for (const auto& [icon, name] : {std::pair{Icon::first, "first"},
                                   {Icon::back, "previous"},
                                   {play, "play"},
                                   {Icon::on, "next"},
                                   {Icon::last, "last"}}) {
    icon_button(ui, icon, name, side);
    ImGui::SameLine();
  }
  const Recording* recording = ui.state.document.recording.get();
  const std::string last = recording ? time_text(*recording, recording->frame_count() - 1) : "";
  const float longest_px = ImGui::CalcTextSize(last.c_str()).x;
  const float numbers = std::round(std::max(136 * s, longest_px + 88 * s));
  const float label = place.width >= 900 * s ? std::round(kLabelWidth * s) : 0;
  const float left = place.x + ImGui::GetCursorPosX() + 10 * s + label;
  const float room = place.right() - 24 * s - left;
  const bool numbered = room - numbers > 80 * s;  // the axis is more important than the numbers
  const Inspection* shown = ui.inspection();
  const bool failed = shown != nullptr && shown->initialization && !shown->initialization->ok;
  const bool legend = shown != nullptr && (failed || !shown->growth.empty()) &&
                      place.height >= 70 * s && place.width >= 700 * s;
  const float width = numbered ? room - numbers : room;
  const float height = place.height - std::round(legend ? 34 * s : 22 * s);
  const float gutter = numbered ? numbers : 0;
  draw_over_time(
      ui, {left, place.y + std::round(12 * s), width, height}, {label > 0, legend, gutter});
  if (numbered)
    draw_numbers(ui,
                 place.right() - numbers - 8 * s,
                 place.y + std::round(place.height / 2 - ImGui::GetTextLineHeight() - 2 * s));
  ImGui::PopStyleVar();
}

}  // namespace gpo
