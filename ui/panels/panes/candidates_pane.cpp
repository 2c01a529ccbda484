// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/facts/candidate_facts.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/views/overlay/overlay.h"

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr ColumnText kReadingColumns[] = {
    {"verdict", "Taken, or why not"},
    {"normal (x, y, z)", "Of the plane, in the reference camera; unit length"},
    {"tilt [\u00b0]",
     "Angle between the normal and the optical axis; 0: the plane faces the camera"},
    {"rotation [\u00b0]", "Angle by which the camera turned since the reference frame"},
    {"|tau| [d]", "How far the camera moved, in distances of the plane"},
    {"score [\u00b0]", "Angle between this rotation and the window's given one; less is better"},
    {"behind", "Inliers that this reading puts behind a camera, of all"}};

void header() {
  ImGui::TableSetupScrollFreeze(0, 1);
  for (const ColumnText& column : kReadingColumns) ImGui::TableSetupColumn(column.title);
  table_header(kReadingColumns);
}

void draw_verdict(const HomographyCandidate& candidate, float scale) {
  const bool taken = candidate.taken();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float half = ImGui::GetTextLineHeight() / 2;
  draw_sign(*ImGui::GetWindowDrawList(),
            taken ? Sign::circle : Sign::cross,
            {at.x + half, at.y + half},
            taken ? color_of(Role::inlier) : color_of(Role::outlier));
  ImGui::SetCursorScreenPos({at.x + 20 * scale, at.y});
  ImGui::TextUnformatted(taken ? "taken" : candidate.rejected.c_str());
}

void draw_row(const HomographyCandidate& candidate, float scale) {
  ImGui::TableNextRow();
  const bool taken = candidate.taken();
  ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(taken ? Role::text : Role::text_dim));
  ImGui::TableNextColumn();
  draw_verdict(candidate, scale);
  for (const std::string& cell : candidate_cells(candidate)) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(cell.c_str());
  }
  ImGui::PopStyleColor();
}

/// Narrow panes scroll sideways.
void draw_table(const std::vector<HomographyCandidate>& candidates, ImVec2 size, float scale) {
  const auto flags = ImGuiTableFlags_ScrollX | ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg |
                     ImGuiTableFlags_SizingFixedFit;
  ImGui::PushFont(font(Font::small));
  if (ImGui::BeginTable("readings", static_cast<int>(std::size(kReadingColumns)), flags, size)) {
    header();
    for (const HomographyCandidate& candidate : candidates) draw_row(candidate, scale);
    ImGui::EndTable();
  }
  ImGui::PopFont();
}

}  // namespace

void candidates_pane(const PanelInput& input,
                     const Rectangle& place,
                     Views& /*views*/,
                     Commands& /*commands*/) {
  const WorkbenchState& state = input.state;
  if (!input.inspection())
    return draw_empty(place,
                      "The readings of the frame's homography appear when the window is computed");
  std::string why = why_no_study(state, "Reading the homographies of all frames \u2026");
  if (!why.empty()) return draw_empty(place, why);
  const int frame = state.view.frame - state.results.study->window->start;
  why = why_no_candidates(*state.results.study, frame);
  if (!why.empty()) return draw_empty(place, why);
  const std::vector<HomographyCandidate>& candidates = state.results.study->candidates[frame];
  const float s = input.scale, inset = 12 * s;
  ImGui::SetCursorScreenPos({place.x + inset, place.y + 8 * s});
  ImGui::BeginGroup();
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + place.width - 2 * inset);
  ImGui::TextUnformatted(
      fmt::format("Frame {}: {}", state.view.frame, candidates_sentence(candidates)).c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndGroup();
  const float top = ImGui::GetItemRectMax().y + 8 * s;
  ImGui::SetCursorScreenPos({place.x + inset, top});
  draw_table(candidates, {place.width - 2 * inset, place.bottom() - top - 4 * s}, s);
}

}  // namespace gpo
