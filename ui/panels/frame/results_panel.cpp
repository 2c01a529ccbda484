// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/look/numbers.h"
#include "ui/panels/facts/facts.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/views/overlay/plane_style.h"

#include <cmath>

namespace gpo {
namespace {

/// Left and right edge of the rows, and the gap between their parts [px from the panel's edge].
struct RowPlace {
  float left, right, gap;
};

/// Not SameLine(x), which counts from the group's left edge.
void continue_line_at(float x) {
  ImGui::SameLine();
  ImGui::SetCursorPosX(std::round(x));
}

/// Draws a small dim note that ends at `right`. Returns false if there is no room for it.
bool draw_note(const std::string& note, float right, float gap) {
  ImGui::PushFont(font(Font::small));
  const float drawn_to = ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x;
  const float left = right - ImGui::CalcTextSize(note.c_str()).x - gap;
  const bool fits = left > drawn_to + gap;
  if (fits) {
    continue_line_at(left);
    colored_text(Role::text_dim, note);
  }
  ImGui::PopFont();
  return fits;
}

/// Draws the value flush right and its note left of it. Returns false if the note does not fit.
bool draw_value(const ResultRow& row, const RowPlace& place) {
  const float left = place.right - ImGui::CalcTextSize(row.value.c_str()).x;
  const bool fits = row.note.empty() || draw_note(row.note, left, place.gap);
  continue_line_at(left);
  colored_text(row.color, row.value);
  return fits;
}

void draw_row(const ResultRow& row, const RowPlace& place) {
  ImGui::SetCursorPosX(place.left);
  ImGui::BeginGroup();
  ImGui::TextUnformatted(row.label.c_str());
  const bool fits = draw_value(row, place);
  ImGui::EndGroup();
  tooltip(fits ? row.tooltip : row.note + ". " + row.tooltip);
}

/// Draws many short rows in two columns and the small font.
void draw_pairs(const ResultGroup& group, const RowPlace& place) {
  ImGui::PushFont(font(Font::small));
  const float middle = std::round((place.left + place.right) / 2);
  for (std::size_t i = 0; i < group.rows.size(); ++i) {
    const bool second = i % 2 == 1;
    if (second) ImGui::SameLine();
    draw_row(group.rows[i],
             second ? RowPlace{middle + place.gap, place.right, place.gap}
                    : RowPlace{place.left, middle - place.gap, place.gap});
  }
  ImGui::PopFont();
}

/// Draws the verdict as sign and word, the normal uncertainty of the result (without a result that
/// of the window) at the right, and the reason below.
void draw_verdict(const Initialization& result, const RowPlace& place, float scale) {
  const Verdict& verdict = *result.verdict;
  const std::optional<double> sigma_deg = result.uncertainty
                                              ? std::optional(result.uncertainty->normal_sigma_deg)
                                              : verdict.normal_sigma_deg;
  const ReadinessStyle look = style_of(verdict.readiness);
  ImGui::SetCursorPosX(place.left);
  ImGui::BeginGroup();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 middle(at.x + 6 * scale, at.y + ImGui::GetTextLineHeight() / 2);
  draw_sign(*ImGui::GetWindowDrawList(), look.sign, middle, look.rgb);
  ImGui::SetCursorPosX(std::round(place.left + 18 * scale));
  ImGui::PushFont(font(Font::bold));
  colored_text(look.rgb, to_string(verdict.readiness));
  ImGui::PopFont();
  if (sigma_deg) draw_value({.value = "\u00b1" + angle_text(*sigma_deg), .note = "normal"}, place);
  ImGui::PushFont(font(Font::small));
  ImGui::PushTextWrapPos(place.right);
  ImGui::TextUnformatted(verdict.reason.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopFont();
  ImGui::EndGroup();
  tooltip("Whether the window determines plane and poses: " + verdict_text(verdict));
}

void draw_state(const PanelInput& input, float right) {
  const bool stale =
      input.inspection() && !(input.inspection()->settings == input.state.document.settings);
  const char* text = input.worker.busy ? "computing" : stale ? "from earlier settings" : "";
  ImGui::PushFont(font(Font::small));
  continue_line_at(right - ImGui::CalcTextSize(text).x);
  colored_text(Role::warning, text);
  ImGui::PopFont();
}

}  // namespace

void results_panel(const PanelContext& ui, const Rectangle& place) {
  const float s = ui.scale;
  const PanelScope scope("results", place, {12 * s, 4 * s}, PanelKind::scrolling);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * s, 3 * s});
  const float left = ImGui::GetCursorPosX();
  const RowPlace rows{left, left + ImGui::GetContentRegionAvail().x, std::round(8 * s)};
  const Initialization* result = ui.inspection() ? ui.inspection()->initialization.get() : nullptr;
  bool first = true;
  for (const ResultGroup& group :
       result_groups(ui.inspection(), ui.timings, ui.state.document.cube_side)) {
    if (!first) ImGui::Dummy({1, 2 * s});
    heading(group.title.c_str());
    if (first) draw_state(ui, rows.right);
    if (group.title == kVerdictTitle && result && result->verdict) draw_verdict(*result, rows, s);
    if (group.title == kTimeTitle) {
      draw_pairs(group, rows);
    } else {
      for (const ResultRow& row : group.rows) draw_row(row, rows);
    }
    first = false;
  }
  if (result && !result->ok && !(result->verdict && result->verdict->reason == result->reason)) {
    ImGui::PushTextWrapPos(rows.right);
    ImGui::TextUnformatted(result->reason.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::PopStyleVar();
}

}  // namespace gpo
