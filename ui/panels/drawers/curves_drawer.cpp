// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/drawers/chart_item.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

/// A name of the legend, in its curve's color; dim where it is hidden. A click switches it.
void draw_name(const Configuration& one, bool shown, const ImVec2& size, Commands& commands) {
  const std::string key = key_of(one);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (hit_area(("curve " + key).c_str(), size))
    push(commands, RunAction{fmt::format("curve {} {}", key, shown ? "off" : "on")});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool hovered = ImGui::IsItemHovered();
  if (hovered)
    list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, imgui_color(Role::hovered), 3);
  const float line = ImGui::GetTextLineHeight(), middle = std::round(at.y + size.y / 2);
  const float dash = line * 1.1F, left = at.x + line * 0.4F;
  list.AddLine({left, middle},
               {left + dash, middle},
               imgui_color(color_of(one), shown ? 1 : 0.35),
               shown ? line * 0.2F : line * 0.1F);
  list.AddText({std::round(left + dash + line * 0.4F), std::round(middle - line / 2)},
               imgui_color(shown ? Role::text : Role::text_dim, shown ? 1 : 0.6),
               title_of(one).c_str());
  tooltip(shown ? "Click: hides these curves" : "Click: shows these curves");
}

/// What the curves are of, and how far they are: to the right of the names, or below.
std::string state_text(const WorkbenchState& state, const CurveFacts& facts) {
  if (facts.of > facts.done) return fmt::format("computing {}/{}", facts.done, facts.of);
  const bool bound = facts.figure.charts.size() == 3;  // with truth
  const char* dotted = bound ? " \u00b7 dotted: the least that the PNE can be" : "";
  if (state.results.experiment) return state.results.experiment_name + dotted;
  return fmt::format("windows from frame {}{}", state.document.settings.start, dotted);
}

/// The names in as many lines as they take. Returns where the charts begin [screen px].
float draw_names(const PanelInput& input,
                 const Rectangle& place,
                 const CurveFacts& facts,
                 Commands& commands) {
  const WorkbenchState& state = input.state;
  const float s = input.scale, line = ImGui::GetTextLineHeight();
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
    draw_name(one, shown, {width, height}, commands);
  }
  const std::string text = facts.note.empty() ? state_text(state, facts) : facts.note;
  const float close = state.results.experiment ? 60 * s : 0;
  x += 10 * s;
  next(ImGui::CalcTextSize(text.c_str()).x + 10 * s);
  ImGui::SetCursorScreenPos({ImGui::GetCursorScreenPos().x, std::round(y + 3 * s)});
  const float room = place.right() - ImGui::GetCursorScreenPos().x - 8 * s - close;
  clipped_text(
      text, room, facts.of > facts.done ? color_of(Role::accent) : color_of(Role::text_dim));
  if (state.results.experiment) {
    ImGui::SameLine();
    if (ImGui::SmallButton("Close")) push(commands, RunAction{"close-results"});
    tooltip("The curves show this recording again");
  }
  return y + height;
}

void draw_chart(const PanelInput& input,
                const Rectangle& place,
                const Chart& chart,
                Views& views,
                Commands& commands) {
  const WorkbenchState& state = input.state;
  const ChartItem item = chart_item("curves " + chart.y_label, place, views, chart, false);
  if (!state.document.recording) return;
  // Over the length of the window that ends at the frame.
  drag_frame(item, state, state.document.settings.start - 1, color_of(Role::text), commands);
}

std::string why_empty(const WorkbenchState& state, const CurveFacts& facts) {
  if (!state.document.recording && !state.results.experiment)
    return "Open a recording, or a results.csv that `evaluate` wrote, to see errors over the "
           "length of the window";
  if (facts.done > 0 && std::size(state.view.hidden_curves) > 0)
    return "All curves are hidden: click a name to show them";
  if (facts.done > 0 && facts.done == facts.of)
    return "None of the compared methods could be computed on these windows";
  return "The curves appear as the compared methods are computed";
}

}  // namespace

void curves_drawer(const PanelInput& input,
                   const Rectangle& place,
                   Views& views,
                   Commands& commands) {
  const CurveFacts& facts = views.curves.of(input.state);
  if (!input.state.document.recording && !input.state.results.experiment)
    return draw_empty(place, why_empty(input.state, facts));
  const float top = draw_names(input, place, facts, commands);
  const Rectangle below{place.x, top, place.width, std::max(1.0F, place.bottom() - top)};
  const auto& charts = facts.figure.charts;
  if (charts.empty()) return draw_empty(below, why_empty(input.state, facts));
  const float width = std::floor(below.width / static_cast<float>(charts.size()));
  for (std::size_t i = 0; i < charts.size(); ++i)
    draw_chart(input,
               {below.x + width * static_cast<float>(i), below.y, width, below.height},
               charts[i],
               views,
               commands);
}

}  // namespace gpo
