// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The compared results in numbers, the times, and the log.
#include "ui/panels/panels.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

namespace gpo {
namespace {

template <class Range, class Name>
float widest_px(const Range& range, const Name& name) {
  float widest = 0;
  for (const auto& one : range)
    widest = std::max(widest, ImGui::CalcTextSize(std::string(name(one)).c_str()).x);
  return widest;
}

void header_cell(const char* title, const char* meaning) {
  ImGui::TableNextColumn();
  colored_text(Role::text_dim, title);
  tooltip(meaning);
}

/// A click sorts: ascending, descending, unsorted.
void number_header(int index, const ComparedColumn& column, TableOrder& order) {
  ImGui::TableNextColumn();
  const bool sorts = order.column == index;
  colored_text(sorts ? Role::accent : Role::text_dim, column.title);
  const bool pressed = ImGui::IsItemClicked();
  tooltip(std::string(column.meaning) + ". Click to sort");
  if (sorts) {
    const float size = font(Font::small)->FontSize;
    ImGui::SameLine(0, size / 3);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float low = at.y + size * 0.85F, high = at.y + size * 0.35F, half = size * 0.3F;
    const float tip = order.descending ? low : high, base = order.descending ? high : low;
    ImGui::GetWindowDrawList()->AddTriangleFilled(
        {at.x, base}, {at.x + 2 * half, base}, {at.x + half, tip}, imgui_color(Role::accent));
    ImGui::Dummy({2 * half, size});
  }
  if (!pressed) return;
  if (!sorts)
    order = {index, false};
  else
    order = order.descending ? TableOrder{} : TableOrder{index, true};
}

void header(const std::vector<ComparedRow>& rows, TableOrder& order) {
  const float width =
      widest_px(rows, [](const ComparedRow& row) { return title_of(row.configuration); });
  ImGui::TableSetupScrollFreeze(1, 1);
  ImGui::TableSetupColumn(
      "method", ImGuiTableColumnFlags_WidthFixed, width + 1.5F * ImGui::GetTextLineHeight());
  ImGui::TableSetupColumn("status");
  for (const ComparedColumn& column : compared_columns()) ImGui::TableSetupColumn(column.title);
  // Not a row of headers, whose text Dear ImGui ignores when it chooses widths.
  ImGui::TableNextRow();
  ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg0, imgui_color(Role::raised));
  header_cell("Method", "Click to make the row's method current, right-click to copy as CSV");
  header_cell("Status", "Success or failure, and the method's verdict on the window");
  int index = 0;
  for (const ComparedColumn& column : compared_columns()) number_header(index++, column, order);
}

void copy_menu(const std::vector<ComparedRow>& rows) {
  if (!ImGui::BeginPopupContextWindow("copy")) return;
  if (ImGui::MenuItem("Copy the table as CSV")) ImGui::SetClipboardText(to_csv(rows).c_str());
  for (const ComparedRow& row : rows) {
    const std::string title = "Copy " + title_of(row.configuration) + " as CSV";
    if (ImGui::MenuItem(title.c_str())) ImGui::SetClipboardText(to_csv({&row, 1}).c_str());
  }
  ImGui::EndPopup();
}

void draw_name(const ComparedRow& row, bool current, float height, Commands& commands) {
  ImGui::TableNextColumn();
  const std::string label = "##" + key_of(row.configuration);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float line = ImGui::GetTextLineHeight();
  if (ImGui::Selectable(label.c_str(), current, ImGuiSelectableFlags_SpanAllColumns, {0, height}))
    push(commands, ChangeSettings{row.settings});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 bar_end(at.x + std::round(line * 0.3F), at.y + height - 2);
  list.AddRectFilled({at.x, at.y + 2}, bar_end, imgui_color(color_of(row.configuration)), 2);
  const ImVec2 name(std::round(at.x + line * 0.7F), at.y);
  list.AddText(name, imgui_color(Role::text), title_of(row.configuration).c_str());
  if (!current) return;
  write_text(list, Font::small, {name.x, at.y + line}, "current", color_of(Role::accent));
}

void draw_status(const ComparedRow& row, const std::optional<Verdict>& verdict) {
  ImGui::TableNextColumn();
  ImGui::BeginGroup();
  const bool failed = !row.reason.empty(), computing = row.numbers.empty();
  colored_text(failed ? Role::bad : computing ? Role::accent : Role::good, row.status);
  ImGui::PushFont(font(Font::small));
  if (verdict) {
    const SignStyle look = style_of(verdict->readiness);
    sign_at_cursor(look.sign, look.rgb);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetTextLineHeight() * 1.2F);
    colored_text(look.rgb, to_string(verdict->readiness));
  }
  ImGui::PopFont();
  ImGui::EndGroup();
  tooltip(failed ? row.reason : verdict ? verdict_text(*verdict) : "");
}

std::uint32_t color_of_difference(double worse) {
  if (std::abs(worse) < 0.01) return color_of(Role::text_dim);
  return mixed_rgb(color_of(Role::text_dim),
                   color_of(worse > 0 ? Role::bad : Role::good),
                   0.35 + 0.65 * std::abs(worse));
}

void draw_number(const ComparedNumber& number) {
  ImGui::TableNextColumn();
  ImGui::BeginGroup();
  colored_text(number.why_not.empty() ? Role::text : Role::text_dim, number.text);
  text_in(Font::small, color_of_difference(number.worse), number.difference);
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

struct StageText {
  const char *title, *meaning;
  Role color;
};
constexpr std::array<StageText, 5> kStageTexts = {
    {{"tracking", "Tracking of corners from frame to frame", Role::tracking},
     {"RANSAC", "Homographies of all frames, and the tracks that fit them", Role::ransac},
     {"rotations", "Rotations from the gyroscope or from homographies", Role::rotations},
     {"initialization", "The method itself, without its optimization", Role::initialization},
     {"optimization", "The method's iterative solver", Role::optimization}}};

std::array<double, 5> stages_ms(const Timing& t) {
  return {t.track, t.ransac, t.rotations, std::max(0.0, t.initialize - t.optimize), t.optimize};
}

double sum_ms(const Timing& timing) {
  const auto stages = stages_ms(timing);
  return std::accumulate(stages.begin(), stages.end(), 0.0);
}

void stage_header(float scale) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  colored_text(Role::text_dim, "[ms]");
  for (const StageText& stage : kStageTexts) {
    ImGui::TableNextColumn();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float side = 9 * scale, y = at.y + (ImGui::GetTextLineHeight() - side) / 2;
    ImGui::GetWindowDrawList()->AddRectFilled(
        {at.x, y}, {at.x + side, y + side}, imgui_color(stage.color), 2 * scale);
    ImGui::SetCursorScreenPos({at.x + side + 5 * scale, at.y});
    colored_text(Role::text_dim, stage.title);
    tooltip(stage.meaning);
  }
  header_cell("sum", "Sum of all stages");
  ImGui::TableNextColumn();
}

/// A bar that fills the column for `longest_ms`.
void draw_stage_bar(const ShownResult& result, double longest_ms) {
  const auto stages = stages_ms(result.inspection->timing);
  const double sum = sum_ms(result.inspection->timing);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetTextLineHeight();
  double left = at.x;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const auto from = static_cast<float>(std::round(left));
    left += width * stages[i] / longest_ms;
    const auto to = static_cast<float>(std::round(left));
    if (to <= from) continue;
    const auto& [title, meaning, color] = kStageTexts[i];
    ImGui::GetWindowDrawList()->AddRectFilled(
        {from, at.y}, {to, at.y + height}, imgui_color(color));
    hit_area_at(title, {from, at.y, to - from, height});
    const std::string own = milliseconds_text(stages[i]), all = milliseconds_text(sum);
    const double percent = 100 * stages[i] / sum;
    tooltip(fmt::format("{}, {}: {}, {:.0f} % of {}", result.name, title, own, percent, all));
  }
}

/// `row`: index that identifies its items.
void draw_times(const ShownResult& result, int row, double longest_ms, bool timings, float scale) {
  ImGui::TableNextRow();
  ImGui::PushID(row);
  ImGui::TableNextColumn();
  marked_name(result.current ? Sign::disc : Sign::dot, result.rgb, result.name, scale);
  const auto number = [&](double ms) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(timings ? number_text(ms, 2).c_str() : "\u2013");
    if (!timings) tooltip(kNoTimes);
  };
  for (const double stage : stages_ms(result.inspection->timing)) number(stage);
  number(sum_ms(result.inspection->timing));
  ImGui::TableNextColumn();
  if (timings && longest_ms > 0) draw_stage_bar(result, longest_ms);
  ImGui::PopID();
}

/// Gives results of the same tracks the same time of tracking, that of the first: they were tracked
/// more than once, maybe while other work ran.
std::vector<ShownResult> with_common_times(std::vector<ShownResult> shown) {
  for (ShownResult& result : shown) {
    const Inspection& first = *shown.front().inspection;
    const auto tracks_of = [](const Inspection& of) {
      return std::tuple(of.settings.start, of.settings.frames, of.settings.tracking);
    };
    if (tracks_of(first) != tracks_of(*result.inspection)) continue;
    Inspection timed = *result.inspection;
    timed.timing.total += first.timing.track - timed.timing.track;
    timed.timing.track = first.timing.track;
    result.inspection = std::make_shared<const Inspection>(std::move(timed));
  }
  return shown;
}

}  // namespace

void table_header(std::span<const ColumnText> columns) {
  ImGui::TableNextRow();
  for (const ColumnText& column : columns) {
    if (!ImGui::TableNextColumn()) continue;
    colored_text(Role::text_dim, column.title);
    tooltip(column.meaning);
  }
}

void frozen_header(std::span<const ColumnText> columns) {
  ImGui::TableSetupScrollFreeze(0, 1);
  for (const ColumnText& column : columns) ImGui::TableSetupColumn(column.title);
  table_header(columns);
}

void table_drawer(const PanelContext& ui, const Rectangle& place) {
  if (!ui.state.document.recording)
    return draw_empty(place, "Open a recording to compare methods on it");
  const std::vector<Compared> results = compared_with_current(ui.state);
  const std::vector<ComparedRow> rows = compared_rows(results, ui.timings);
  const float s = ui.scale;
  ImGui::SetCursorPos({12 * s, 6 * s});
  const auto flags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_ScrollX | ImGuiTableFlags_RowBg |
                     ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_PadOuterX;
  const int columns = static_cast<int>(compared_columns().size()) + 2;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * s, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {9 * s, 3 * s});
  if (ImGui::BeginTable("compared", columns, flags, {place.width - 12 * s, place.height - 6 * s})) {
    header(rows, ui.views.order);
    const Configuration current = name_among_compared(ui.state, ui.state.document.settings);
    for (const std::size_t i : in_order(rows, ui.views.order))
      draw_row(rows[i], results[i], rows[i].configuration == current, ui.commands);
    copy_menu(rows);
    ImGui::EndTable();
  }
  ImGui::PopStyleVar(2);
}

void timing_drawer(const PanelContext& ui, const Rectangle& place) {
  const std::vector<ShownResult> shown = with_common_times(shown_results(ui.state));
  if (shown.empty()) return draw_empty(place, "Times appear once the window is computed");
  double longest_ms = 0;
  for (const ShownResult& result : shown)
    longest_ms = std::max(longest_ms, sum_ms(result.inspection->timing));
  const float s = ui.scale;
  ImGui::SetCursorScreenPos({place.x + 12 * s, place.y + 8 * s});
  constexpr int kColumns = static_cast<int>(kStageTexts.size()) + 3;
  const auto flags = ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollY;
  const ImVec2 size(place.width - 24 * s, place.bottom() - place.y - 12 * s);
  if (!ImGui::BeginTable("timing", kColumns, flags, size)) return;
  // Fixed widths, which do not depend on what was drawn before.
  const auto fixed = [](float width) {
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, width);
  };
  fixed(widest_px(shown, [](const ShownResult& result) { return result.name; }) + 20 * s);
  for (const auto& stage : kStageTexts) fixed(ImGui::CalcTextSize(stage.title).x + 16 * s);
  fixed(56 * s);
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupScrollFreeze(0, 1);
  stage_header(s);
  for (std::size_t i = 0; i < shown.size(); ++i)
    draw_times(shown[i], static_cast<int>(i), longest_ms, ui.timings, s);
  ImGui::EndTable();
}

void log_drawer(const PanelContext& ui, const Rectangle& place) {
  if (ui.state.messages.lines.empty()) return draw_empty(place, "No messages yet");
  const float s = ui.scale;
  ImGui::SetCursorPos({12 * s, 6 * s});
  ImGui::BeginChild("lines", {place.width - 12 * s, place.height - 6 * s});
  ImGui::PushTextWrapPos(0);
  for (const LogLine& line : ui.state.messages.lines)
    colored_text(role_of(line.severity, Role::text), line.text);
  ImGui::PopTextWrapPos();
  if (ImGui::GetScrollY() >= ImGui::GetScrollMaxY()) ImGui::SetScrollHereY(1);
  ImGui::EndChild();
}

}  // namespace gpo
