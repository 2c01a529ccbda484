// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/facts/compare_facts.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/views/overlay/overlay.h"
#include "ui/views/overlay/plane_style.h"

#include <algorithm>
#include <cmath>

namespace gpo {
namespace {

/// Ascending, descending, as it was.
TableOrder clicked(const TableOrder& order, int column) {
  if (order.column != column) return {column, false};
  return order.descending ? TableOrder{} : TableOrder{column, true};
}

void header_cell(const char* title, const char* meaning) {
  ImGui::TableNextColumn();
  colored_text(Role::text_dim, title);
  tooltip(meaning);
}

/// A click on it puts the rows in order.
void number_header(int index, const ComparedColumn& column, TableOrder& order) {
  ImGui::TableNextColumn();
  const bool orders = order.column == index;
  colored_text(orders ? Role::accent : Role::text_dim, column.title);
  const bool pressed = ImGui::IsItemClicked();
  tooltip(std::string(column.meaning) + ". Click: puts the rows in order");
  if (orders) {
    const float size = font(Font::small)->FontSize;
    ImGui::SameLine(0, size / 3);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float low = at.y + size * 0.85F, high = at.y + size * 0.35F, half = size * 0.3F;
    const float tip = order.descending ? low : high, base = order.descending ? high : low;
    ImGui::GetWindowDrawList()->AddTriangleFilled(
        {at.x, base}, {at.x + 2 * half, base}, {at.x + half, tip}, imgui_color(Role::accent));
    ImGui::Dummy({2 * half, size});
  }
  if (pressed) order = clicked(order, index);
}

/// Kept with the window that the table is in.
TableOrder kept_order() {
  const int kept = ImGui::GetStateStorage()->GetInt(ImGui::GetID("order"));
  return {std::abs(kept) - 1, kept < 0};
}

void keep_order(const TableOrder& order) {
  const int code = order.column + 1;
  ImGui::GetStateStorage()->SetInt(ImGui::GetID("order"), order.descending ? -code : code);
}

/// Right click anywhere in the table.
void copy_menu(const std::vector<ComparedRow>& rows) {
  if (!ImGui::BeginPopupContextWindow("copy")) return;
  if (ImGui::MenuItem("Copy the table as CSV")) ImGui::SetClipboardText(to_csv(rows).c_str());
  for (const ComparedRow& row : rows) {
    const std::string title = "Copy " + title_of(row.configuration) + " as CSV";
    if (ImGui::MenuItem(title.c_str())) ImGui::SetClipboardText(to_csv({&row, 1}).c_str());
  }
  ImGui::EndPopup();
}

float widest_name(const std::vector<ComparedRow>& rows) {
  float widest = 0;
  for (const ComparedRow& row : rows)
    widest = std::max(widest, ImGui::CalcTextSize(title_of(row.configuration).c_str()).x);
  return widest + 1.5F * ImGui::GetTextLineHeight();
}

void header(const std::vector<ComparedRow>& rows, TableOrder& order) {
  ImGui::TableSetupScrollFreeze(1, 1);
  ImGui::TableSetupColumn("method", ImGuiTableColumnFlags_WidthFixed, widest_name(rows));
  ImGui::TableSetupColumn("status");
  for (const ComparedColumn& column : compared_columns()) ImGui::TableSetupColumn(column.title);
  // Not a row of headers: of those ImGui does not count the text when it chooses widths.
  ImGui::TableNextRow();
  ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg0, imgui_color(Role::raised));
  header_cell("Method", "Click a row: makes it the current method. Right click: copies as CSV");
  header_cell("Status", "Whether it solved the window, and how fit the window is by its result");
  int index = 0;
  for (const ComparedColumn& column : compared_columns()) number_header(index++, column, order);
}

void draw_name(const ComparedRow& row, bool current, float height, Commands& commands) {
  ImGui::TableNextColumn();
  const std::string label = "##" + key_of(row.configuration);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float line = ImGui::GetTextLineHeight();
  if (ImGui::Selectable(label.c_str(), current, ImGuiSelectableFlags_SpanAllColumns, {0, height}))
    push(commands, ChangeSettings{row.settings});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({at.x, at.y + 2},
                     {at.x + std::round(line * 0.3F), at.y + height - 2},
                     imgui_color(color_of(row.configuration)),
                     2);
  const ImVec2 name(std::round(at.x + line * 0.7F), at.y);
  list.AddText(name, imgui_color(Role::text), title_of(row.configuration).c_str());
  if (!current) return;
  write_text(list, Font::small, {name.x, at.y + line}, "current", color_of(Role::accent));
}

/// The sign and word of the verdict, or what became of it instead.
void draw_status(const ComparedRow& row, const std::optional<Verdict>& verdict) {
  ImGui::TableNextColumn();
  ImGui::BeginGroup();
  const bool failed = !row.reason.empty(), computing = row.numbers.empty() && !failed;
  const std::uint32_t rgb = failed      ? color_of(Role::bad)
                            : computing ? color_of(Role::accent)
                                        : color_of(Role::good);
  colored_text(rgb, row.status);
  ImGui::PushFont(font(Font::small));
  if (verdict) {
    const ReadinessStyle look = style_of(verdict->readiness);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float line = ImGui::GetTextLineHeight();
    draw_sign(*ImGui::GetWindowDrawList(), look.sign, {at.x + line / 2, at.y + line / 2}, look.rgb);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + line * 1.2F);
    colored_text(look.rgb, to_string(verdict->readiness));
  }
  ImGui::PopFont();
  ImGui::EndGroup();
  tooltip(failed ? row.reason : verdict ? verdict_text(*verdict) : "");
}

/// Dim where it hardly differs; the more, the stronger in the color of better or worse.
std::uint32_t color_of_difference(double worse) {
  const double strength = 0.35 + 0.65 * std::abs(worse);
  if (std::abs(worse) < 0.01) return color_of(Role::text_dim);
  return mixed_rgb(
      color_of(Role::text_dim), worse > 0 ? color_of(Role::bad) : color_of(Role::good), strength);
}

void draw_number(const ComparedNumber& number) {
  ImGui::TableNextColumn();
  ImGui::BeginGroup();
  colored_text(number.why_not.empty() ? color_of(Role::text) : color_of(Role::text_dim),
               number.text);
  ImGui::PushFont(font(Font::small));
  colored_text(color_of_difference(number.worse), number.difference);
  ImGui::PopFont();
  ImGui::EndGroup();
  tooltip(number.why_not);
}

void draw_row(const ComparedRow& row, const Compared& one, bool current, Commands& commands) {
  ImGui::TableNextRow();
  const float height = ImGui::GetTextLineHeight() + font(Font::small)->FontSize + 2;
  ImGui::PushID(key_of(row.configuration).c_str());
  draw_name(row, current, height, commands);
  draw_status(row, one.inspection ? one.inspection->initialization->verdict : std::nullopt);
  for (const ComparedNumber& number : row.numbers) draw_number(number);
  ImGui::PopID();
}

}  // namespace

void table_drawer(const PanelInput& input,
                  const Rectangle& place,
                  Views& /*views*/,
                  Commands& commands) {
  if (!input.state.document.recording)
    return draw_empty(place, "Open a recording to compare methods on it");
  const std::vector<Compared> results = compared_with_current(input.state);
  const std::vector<ComparedRow> rows = compared_rows(results, input.timings);
  const float s = input.scale;
  ImGui::SetCursorPos({12 * s, 6 * s});
  const auto flags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_ScrollX | ImGuiTableFlags_RowBg |
                     ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_PadOuterX;
  const int columns = static_cast<int>(compared_columns().size()) + 2;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * s, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {9 * s, 3 * s});
  if (ImGui::BeginTable("compared", columns, flags, {place.width - 12 * s, place.height - 6 * s})) {
    TableOrder order = kept_order();
    header(rows, order);
    keep_order(order);
    const Configuration current = called_among_compared(input.state, input.state.document.settings);
    for (const std::size_t i : in_order(rows, order))
      draw_row(rows[i], results[i], rows[i].configuration == current, commands);
    copy_menu(rows);
    ImGui::EndTable();
  }
  ImGui::PopStyleVar(2);
}

}  // namespace gpo
