// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Charts as parts of a panel, and the drawers of them: curves over the window length, residuals.
#include "ui/panels/panels.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {

ChartItem chart_item(const std::string& name,
                     const Rectangle& place,
                     Views& views,
                     const Chart& chart,
                     bool legend) {
  ChartItem item;
  if (place.width < 1 || place.height < 1) return item;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  item.to = draw_chart_view({list, screen_rect(place)}, views.charts[name], chart, legend);
  hit_area_at(name.c_str(), place);
  item.held = ImGui::IsItemActive();
  if (ImGui::BeginPopupContextItem()) {
    if (ImGui::MenuItem("Copy the data as CSV")) ImGui::SetClipboardText(to_csv(chart).c_str());
    ImGui::EndPopup();
  }
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const bool over = item.to.inside({mouse.x, mouse.y});
  if (!item.held && !(ImGui::IsItemHovered() && over)) return item;
  item.hovered = std::clamp(item.to.x_value(mouse.x), item.to.x_low, item.to.x_high);
  const std::string values = chart_values_at(chart, *item.hovered);
  if (values.empty()) return item;
  draw_chart_cursor(list, item.to, *item.hovered, color_of(Role::text_dim));
  show_tooltip(values);
  return item;
}

void drag_frame(const ChartItem& item, const PanelContext& ui, int zero, Role role) {
  const int now = ui.state.view.frame;
  draw_chart_cursor(*ImGui::GetWindowDrawList(), item.to, now - zero, color_of(role));
  if (!item.held || !item.hovered) return;
  const int frame = zero + static_cast<int>(std::lround(*item.hovered));
  if (frame != now) push(ui.commands, GoToFrame{frame});
}

namespace {

/// A name of the legend in the color of its curves; a click shows or hides them.
void draw_name(const Configuration& one, bool shown, const ImVec2& size, Commands& commands) {
  const std::string key = key_of(one);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (hit_area(("curve " + key).c_str(), size))
    push(commands, RunAction{fmt::format("curve {} {}", key, shown ? "off" : "on")});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (ImGui::IsItemHovered())
    list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, imgui_color(Role::hovered), 3);
  const float line = ImGui::GetTextLineHeight(), middle = std::round(at.y + size.y / 2);
  const float dash = line * 1.1F, left = at.x + line * 0.4F;
  const ImU32 color = imgui_color(color_of(one), shown ? 1 : 0.35);
  list.AddLine({left, middle}, {left + dash, middle}, color, line * (shown ? 0.2F : 0.1F));
  list.AddText({std::round(left + dash + line * 0.4F), std::round(middle - line / 2)},
               imgui_color(shown ? Role::text : Role::text_dim, shown ? 1 : 0.6),
               title_of(one).c_str());
  tooltip(shown ? "Click to hide these curves" : "Click to show these curves");
}

std::string state_text(const WorkbenchState& state, const CurveFacts& facts) {
  if (facts.of > facts.done) return fmt::format("computing {}/{}", facts.done, facts.of);
  const bool bound = facts.figure.charts.size() == 3;  // with ground truth
  const char* dotted = bound ? " \u00b7 dotted: Cram\u00e9r-Rao bound of the PNE" : "";
  if (state.results.experiment) return state.results.experiment_name + dotted;
  return fmt::format("windows from frame {}{}", state.document.settings.start, dotted);
}

/// Draws the legend in as many lines as it needs. Returns where the charts begin [screen px].
float draw_names(const PanelContext& ui, const Rectangle& place, const CurveFacts& facts) {
  const WorkbenchState& state = ui.state;
  const float s = ui.scale, line = ImGui::GetTextLineHeight();
  const float height = std::round(line + 6 * s), left = place.x + 8 * s;
  float x = left, y = place.y + 3 * s;
  const auto next = [&](float width) {
    if (x > left && x + width > place.right() - 8 * s) {
      x = left;
      y += height;
    }
    ImGui::SetCursorScreenPos({std::round(x), std::round(y)});
    x += width + 2 * s;
  };
  for (const Configuration& one : facts.configurations) {
    const float width = ImGui::CalcTextSize(title_of(one).c_str()).x + 2.4F * line;
    next(width);
    const auto& hidden = state.view.hidden_curves;
    const bool shown = std::ranges::find(hidden, key_of(one)) == hidden.end();
    draw_name(one, shown, {width, height}, ui.commands);
  }
  const std::string text = facts.note.empty() ? state_text(state, facts) : facts.note;
  const float close = state.results.experiment ? 60 * s : 0;
  x += 10 * s;
  next(ImGui::CalcTextSize(text.c_str()).x + 10 * s);
  ImGui::SetCursorScreenPos({ImGui::GetCursorScreenPos().x, std::round(y + 3 * s)});
  const float room = place.right() - ImGui::GetCursorScreenPos().x - 8 * s - close;
  clipped_text(text, room, color_of(facts.of > facts.done ? Role::accent : Role::text_dim));
  if (state.results.experiment) {
    ImGui::SameLine();
    if (ImGui::SmallButton("Close")) push(ui.commands, RunAction{"close-results"});
    tooltip("Shows the curves of the open recording again");
  }
  return y + height;
}

std::string why_empty(const WorkbenchState& state, const CurveFacts& facts) {
  if (facts.done > 0 && !state.view.hidden_curves.empty())
    return "All curves are hidden. Click a name to show them";
  if (facts.done > 0 && facts.done == facts.of)
    return "None of the compared methods succeeded on these windows";
  return "Curves appear when the compared methods are computed";
}

/// Returns the track under the mouse in any view, else the last selected one; null if none.
const TrackLife* focused_track(const PanelContext& ui) {
  const auto& focus = ui.state.hover.track ? ui.state.hover.track : ui.state.selection.focus;
  if (!focus) return nullptr;
  const auto column = column_of(*ui.inspection()->tracks, *focus);
  return column ? &ui.views.lives.of(*ui.inspection(), *column) : nullptr;
}

}  // namespace

void curves_drawer(const PanelContext& ui, const Rectangle& place) {
  const WorkbenchState& state = ui.state;
  if (!state.document.recording && !state.results.experiment)
    return draw_empty(place,
                      "Open a recording, or a results.csv of `evaluate`, to see errors over the "
                      "length of the window");
  ui.views.curves.update(curve_inputs(state), [&] { return curve_facts(state); });
  const CurveFacts& facts = ui.views.curves.value;
  const float top = draw_names(ui, place, facts);
  const Rectangle below{place.x, top, place.width, std::max(1.0F, place.bottom() - top)};
  const auto& charts = facts.figure.charts;
  if (charts.empty()) return draw_empty(below, why_empty(state, facts));
  const float width = std::floor(below.width / static_cast<float>(charts.size()));
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const Rectangle plot{below.x + width * static_cast<float>(i), below.y, width, below.height};
    const auto item = chart_item("curves " + charts[i].y_label, plot, ui.views, charts[i], false);
    // x is the length of the window, which ends at the frame.
    if (state.document.recording)
      drag_frame(item, ui, state.document.settings.start - 1, Role::text);
  }
}

void residuals_drawer(const PanelContext& ui, const Rectangle& place) {
  const Inspection* inspection = ui.inspection();
  if (inspection == nullptr)
    return draw_empty(place, "Residuals appear when the window is initialized");
  if (!inspection->initialization->ok)
    return draw_empty(
        place, "No residuals without plane and poses: " + inspection->initialization->reason);
  ui.views.residuals.update(ui.state.results.inspection,
                            [&] { return window_residuals(*inspection); });
  const WindowResiduals& residuals = ui.views.residuals.value;
  const float left = std::floor(0.4F * place.width);
  const Chart histogram = residual_histogram(
      residuals, *inspection, ui.state.view.frame, ui.state.view.toggles.log_histogram);
  const Chart rms = rms_chart(residuals, *inspection, focused_track(ui));
  const Rectangle beside{place.x + left, place.y, place.width - left, place.height};
  const Rectangle first{place.x, place.y, left, place.height};
  chart_item("histogram of residuals", first, ui.views, histogram);
  const ChartItem item = chart_item("rms over frames", beside, ui.views, rms);
  drag_frame(item, ui, 0, Role::accent);
}

}  // namespace gpo
