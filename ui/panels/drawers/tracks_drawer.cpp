// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/look/numbers.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/workbench/selection.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr std::array kColumns = {
    ColumnText{"track", "Its id; click: picks it, Ctrl+click beside others, Shift+click a range"},
    ColumnText{"seen", "Frames of the window that see it"},
    ColumnText{"inlier", "Frames in which it is an inlier of its plane"},
    ColumnText{"plane", "Which of the window's planes it lies on, counted by their support"},
    ColumnText{"residual [px]", "RMS reprojection error as an inlier of the leading plane"},
    ColumnText{"depth [d]", "In the reference camera, in distances of the plane"},
    ColumnText{"verdict", "What holds against it"}};

/// Dear ImGui's own, which sorts by a click.
void draw_header() {
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (const ColumnText& column : kColumns) {
    ImGui::TableNextColumn();
    ImGui::TableHeader(column.title);
    tooltip(column.meaning);
  }
}

/// Those of this inspection, sorted as the table's head says.
const std::vector<TrackRow>& rows_of(const PanelInput& input, KeptTrackRows& kept) {
  const auto& inspection = input.state.results.inspection;
  ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs();
  const bool another = kept.of != inspection;
  if (another) kept = {inspection, track_rows(*inspection)};
  if (specs != nullptr && specs->SpecsCount > 0 && (another || specs->SpecsDirty)) {
    const ImGuiTableColumnSortSpecs& by = specs->Specs[0];
    sort_tracks(kept.rows,
                static_cast<TrackColumn>(by.ColumnIndex),
                by.SortDirection == ImGuiSortDirection_Descending);
    specs->SpecsDirty = false;
  }
  return kept.rows;
}

/// From the focus to there, in the order of the list.
std::vector<std::int64_t> range_to(const std::vector<TrackRow>& rows,
                                   const Selection& selection,
                                   std::size_t to) {
  const auto from = std::ranges::find(rows, selection.focus.value_or(rows[to].id), &TrackRow::id);
  std::size_t first = from == rows.end() ? to : static_cast<std::size_t>(from - rows.begin());
  std::size_t last = to;
  if (first > last) std::swap(first, last);
  std::vector<std::int64_t> ids;
  for (std::size_t i = first; i <= last; ++i) ids.push_back(rows[i].id);
  return ids;
}

void click(const std::vector<TrackRow>& rows,
           std::size_t row,
           const Selection& selection,
           Commands& commands) {
  const ImGuiIO& io = ImGui::GetIO();
  const std::int64_t id = rows[row].id;
  push(commands,
       SelectTracks{io.KeyShift  ? selected(range_to(rows, selection, row))
                    : io.KeyCtrl ? toggled(selection, id)
                                 : selected({&id, 1})});
}

void draw_row(const std::vector<TrackRow>& rows,
              std::size_t i,
              const Selection& selection,
              Commands& commands) {
  const TrackRow& row = rows[i];
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  if (ImGui::Selectable(std::to_string(row.id).c_str(),
                        selection.contains(row.id),
                        ImGuiSelectableFlags_SpanAllColumns))
    click(rows, i, selection, commands);
  if (ImGui::IsItemHovered()) push(commands, HoverOver{{row.id}});
  for (const std::string& text : {std::to_string(row.seen),
                                  std::to_string(row.inlier),
                                  row.plane ? std::to_string(*row.plane) : "\u2013",
                                  two_decimals(row.rms_px),
                                  two_decimals(row.depth),
                                  row.verdict}) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(text.c_str());
  }
}

void copy_menu(const std::vector<TrackRow>& rows, const Selection& selection) {
  if (!ImGui::BeginPopupContextWindow("copy")) return;
  if (ImGui::MenuItem("Copy the list as CSV")) ImGui::SetClipboardText(to_csv(rows).c_str());
  if (ImGui::MenuItem("Copy the picked ones as CSV", nullptr, false, !selection.tracks.empty())) {
    std::vector<TrackRow> picked = rows;
    std::erase_if(picked, [&](const TrackRow& row) { return !selection.contains(row.id); });
    ImGui::SetClipboardText(to_csv(picked).c_str());
  }
  ImGui::EndPopup();
}

void draw_list(const PanelInput& input, ImVec2 size, Views& views, Commands& commands) {
  const auto flags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingFixedFit |
                     ImGuiTableFlags_RowBg | ImGuiTableFlags_Sortable;
  if (!ImGui::BeginTable("tracks", static_cast<int>(kColumns.size()), flags, size)) return;
  ImGui::TableSetupScrollFreeze(0, 1);
  for (const ColumnText& column : kColumns)
    ImGui::TableSetupColumn(column.title,
                            column.title == kColumns.back().title
                                ? ImGuiTableColumnFlags_WidthStretch
                                : ImGuiTableColumnFlags_None,
                            column.title == kColumns.back().title ? 0 : 92 * input.scale);
  draw_header();
  const std::vector<TrackRow>& rows = rows_of(input, views.tracks);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(rows.size()));
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
      draw_row(rows, static_cast<std::size_t>(i), input.state.selection, commands);
  copy_menu(rows, input.state.selection);
  ImGui::EndTable();
}

}  // namespace

void tracks_drawer(const PanelInput& input,
                   const Rectangle& place,
                   Views& views,
                   Commands& commands) {
  if (!input.inspection())
    return draw_empty(place, "The tracks appear when the window is computed");
  const float s = input.scale;
  const Selection& selection = input.state.selection;
  ImGui::SetCursorPos({12 * s, 6 * s});
  ImGui::BeginGroup();
  ImGui::PushFont(font(Font::small));
  colored_text(
      Role::text_dim,
      fmt::format("{} tracks, {} picked \u00b7 a click on the head sorts, right click copies",
                  input.inspection()->tracks->track_count(),
                  selection.tracks.size()));
  const float top = ImGui::GetCursorPosY();
  draw_list(input, {place.width - 24 * s, place.height - top}, views, commands);
  ImGui::PopFont();
  ImGui::EndGroup();
}

}  // namespace gpo
