// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/drawers/chart_item.h"

#include "ui/context/theme.h"
#include "ui/panels/widgets.h"
#include "ui/views/charts/chart_view.h"

#include <algorithm>
#include <cmath>

namespace gpo {
namespace {

/// Of the item drawn last, by a right click.
void copy_menu(const Chart& chart) {
  if (!ImGui::BeginPopupContextItem()) return;
  if (ImGui::MenuItem("Copy the data as CSV")) ImGui::SetClipboardText(to_csv(chart).c_str());
  ImGui::EndPopup();
}

}  // namespace

ChartItem chart_item(const std::string& name,
                     const Rectangle& place,
                     Views& views,
                     const Chart& chart,
                     bool legend) {
  ChartItem item;
  if (place.width < 1 || place.height < 1) return item;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  item.to = draw_chart_view(
      list, {{place.x, place.y}, {place.width, place.height}}, views.charts[name], chart, legend);
  ImGui::SetCursorScreenPos({place.x, place.y});
  hit_area(name.c_str(), {place.width, place.height});
  item.held = ImGui::IsItemActive();
  copy_menu(chart);
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

void drag_frame(const ChartItem& item,
                const WorkbenchState& state,
                int zero,
                std::uint32_t rgb,
                Commands& commands) {
  draw_chart_cursor(*ImGui::GetWindowDrawList(), item.to, state.view.frame - zero, rgb);
  if (!item.held || !item.hovered) return;
  const int frame = zero + static_cast<int>(std::lround(*item.hovered));
  if (frame != state.view.frame) push(commands, GoToFrame{frame});
}

}  // namespace gpo
