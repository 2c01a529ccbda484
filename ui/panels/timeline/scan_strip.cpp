// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/timeline/scan_strip.h"

#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/look/numbers.h"
#include "ui/panels/timeline/time_axis.h"
#include "ui/panels/widgets.h"
#include "ui/views/overlay/plane_style.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace gpo {
namespace {

constexpr double kLeast_deg = 0.01, kMost_deg = 10;

std::string legend(const StartScan& scan) {
  const char* error = shown_error(scan) == &ScannedStart::pne_deg ? "PNE" : "standard deviation";
  return fmt::format(
      "scan: {} of the normal, {:g}\u00b0 to {:g}\u00b0, log", error, kLeast_deg, kMost_deg);
}

void draw_columns(ImDrawList& list,
                  const StartScan& scan,
                  const TimeAxis& axis,
                  const Rectangle& place) {
  const auto error = shown_error(scan);
  for (const ScannedStart& start : scan.starts) {
    const float left = slot_begin(axis, start.start);
    const float right = std::max(left + 1, slot_begin(axis, start.start + scan.step) - 1);
    const float height = std::max(2.0F, column_height(start, error) * (place.height - 2));
    const ImU32 color = start.ok ? imgui_color(style_of(start.readiness).rgb, 0.85)
                                 : imgui_color(Role::text_dim, 0.4);
    list.AddRectFilled({left, std::round(place.bottom() - height)}, {right, place.bottom()}, color);
  }
}

void draw_label(ImDrawList& list, const std::string& text, const Rectangle& place, float scale) {
  const ImFont* f = font(Font::small);
  const auto width = static_cast<float>(text_width(Font::small, text));
  const float gap = 4 * scale;
  if (width + 2 * gap > place.width / 2) return;
  const float left = std::round(place.right() - width - 2 * gap);
  list.AddRectFilled({left, place.y},
                     {place.right(), std::round(place.y + f->FontSize + 2 * scale)},
                     imgui_color(Role::background, 0.75));
  write_text(list, Font::small, {left + gap, place.y + scale}, text, color_of(Role::text_dim));
}

}  // namespace

const ScannedStart* start_at(const StartScan& scan, int frame) {
  const int start = frame / scan.step * scan.step;
  const auto found = std::ranges::lower_bound(scan.starts, start, {}, &ScannedStart::start);
  return found != scan.starts.end() && found->start == start ? &*found : nullptr;
}

std::optional<double> ScannedStart::*shown_error(const StartScan& scan) {
  const bool truth = std::ranges::any_of(
      scan.starts, [](const ScannedStart& start) { return start.pne_deg.has_value(); });
  return truth ? &ScannedStart::pne_deg : &ScannedStart::sigma_deg;
}

float column_height(const ScannedStart& start, std::optional<double> ScannedStart::*error) {
  if (!start.ok || !(start.*error)) return 1;
  const double share =
      std::log10(*(start.*error) / kLeast_deg) / std::log10(kMost_deg / kLeast_deg);
  return static_cast<float>(std::clamp(share, 0.0, 1.0));
}

std::string scan_text(const ScannedStart& start) {
  std::string text = fmt::format(
      "start {}: {}", start.start, start.ok ? to_string(start.readiness) : "not initialized");
  if (start.sigma_deg) text += ", normal \u00b1" + angle_text(*start.sigma_deg);
  if (start.pne_deg) text += ", PNE " + angle_text(*start.pne_deg);
  if (!start.reason.empty()) text += "\n" + start.reason;
  return text;
}

void scan_strip(const PanelInput& input, const Rectangle& place, Commands& commands) {
  const WorkbenchState& state = input.state;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(
      {place.x, place.y}, {place.right(), place.bottom()}, imgui_color(Role::raised));
  if (!state.results.scan) return;
  const TimeAxis axis{
      place.x, place.right(), state.frame_count(), holding(state.view.time_span, state.view.frame)};
  ImGui::SetCursorScreenPos({place.x, place.y});
  const bool clicked = hit_area("scan", {place.width, place.height});
  list.PushClipRect({place.x, place.y}, {place.right(), place.bottom()}, true);
  draw_columns(list, *state.results.scan, axis, place);
  const float x = std::round(slot_middle(axis, state.document.settings.start));
  list.AddLine({x, place.y}, {x, place.bottom()}, imgui_color(Role::accent), 2 * input.scale);
  if (!ImGui::IsItemHovered()) draw_label(list, legend(*state.results.scan), place, input.scale);
  list.PopClipRect();
  const ScannedStart* under =
      start_at(*state.results.scan, frame_at(axis, ImGui::GetIO().MousePos.x));
  if (ImGui::IsItemHovered()) {
    const float share = ImGui::GetIO().MousePos.x / ImGui::GetIO().DisplaySize.x;
    ImGui::SetNextWindowPos({ImGui::GetIO().MousePos.x, place.y - 8 * input.scale}, 0, {share, 1});
    tooltip(under ? scan_text(*under) + "\nClick: starts there" : "not scanned");
  }
  if (!clicked || under == nullptr) return;
  Settings settings = state.document.settings;
  settings.start = under->start;
  push(commands, ChangeSettings{settings});
  push(commands, GoToFrame{under->start + settings.frames - 1});
}

}  // namespace gpo
