// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/look/numbers.h"
#include "ui/panels/facts/facts.h"
#include "ui/panels/facts/uncertainty_facts.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/views/overlay/plane_style.h"

#include <cmath>

namespace gpo {
namespace {

std::uint32_t color_of(Tone tone) {
  switch (tone) {
    case Tone::good:
      return color_of(Role::good);
    case Tone::bad:
      return color_of(Role::bad);
    case Tone::dim:
      return color_of(Role::text_dim);
    case Tone::plain:
      break;
  }
  return color_of(Role::text);
}

/// Not SameLine(x): that counts from the group's left edge.
void continue_line_at(float x) {
  ImGui::SameLine();
  ImGui::SetCursorPosX(std::round(x));
}

/// Dim and small; false where there is no room right of what was drawn last.
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

/// Values end at one line, so that their digits can be compared; notes stand to their left. False
/// where there is no room for the note.
bool draw_value(const ResultRow& row, float right, float gap) {
  const float left = right - ImGui::CalcTextSize(row.value.c_str()).x;
  const bool told = row.note.empty() || draw_note(row.note, left, gap);
  continue_line_at(left);
  colored_text(color_of(row.tone), row.value);
  return told;
}

void draw_row(const ResultRow& row, float left, float right, float gap) {
  ImGui::SetCursorPosX(left);
  ImGui::BeginGroup();
  ImGui::TextUnformatted(row.label.c_str());
  const bool told = draw_value(row, right, gap);
  ImGui::EndGroup();
  tooltip(told ? row.tooltip : row.note + ". " + row.tooltip);
}

/// Two columns, in the small font: milliseconds are many, and seldom what one looks for.
void draw_pairs(const ResultGroup& group, float left, float right, float gap) {
  ImGui::PushFont(font(Font::small));
  const float middle = std::round((left + right) / 2);
  for (std::size_t i = 0; i < group.rows.size(); ++i) {
    const bool second = i % 2 == 1;
    if (second) ImGui::SameLine();
    const float from = second ? middle + gap : left;
    draw_row(group.rows[i], from, second ? right : middle - gap, gap);
  }
  ImGui::PopFont();
}

/// Sign and word to the left, the standard deviation of the result's normal to the right (of the
/// window's, where there is no result); the reason, which tells the window's, below.
void draw_verdict(const Initialization& result, float left, float right, float gap, float scale) {
  const Verdict& verdict = *result.verdict;
  const std::optional<double> sigma_deg = result.uncertainty
                                              ? std::optional(result.uncertainty->normal_sigma_deg)
                                              : verdict.normal_sigma_deg;
  const ReadinessStyle look = style_of(verdict.readiness);
  ImGui::SetCursorPosX(left);
  ImGui::BeginGroup();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 middle(at.x + 6 * scale, at.y + ImGui::GetTextLineHeight() / 2);
  draw_sign(*ImGui::GetWindowDrawList(), look.sign, middle, look.rgb);
  ImGui::SetCursorPosX(std::round(left + 18 * scale));
  ImGui::PushFont(font(Font::bold));
  colored_text(look.rgb, to_string(verdict.readiness));
  ImGui::PopFont();
  if (sigma_deg) draw_value({"", "\u00b1" + angle_text(*sigma_deg), "normal", ""}, right, gap);
  ImGui::PushFont(font(Font::small));
  ImGui::PushTextWrapPos(right);
  ImGui::TextUnformatted(verdict.reason.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopFont();
  ImGui::EndGroup();
  tooltip("Whether the window is fit to initialize from: " + verdict_text(verdict));
}

void draw_state(const PanelInput& input, float right) {
  const bool stale =
      input.inspection() && !(input.inspection()->settings == input.state.document.settings);
  const char* text = input.worker.busy ? "computing" : stale ? "of earlier settings" : "";
  ImGui::PushFont(font(Font::small));
  continue_line_at(right - ImGui::CalcTextSize(text).x);
  colored_text(Role::warning, text);
  ImGui::PopFont();
}

}  // namespace

void results_panel(const PanelInput& input, const Rectangle& place) {
  const float s = input.scale;
  const PanelScope panel("results", place, {12 * s, 4 * s}, true);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * s, 3 * s});
  const float left = ImGui::GetCursorPosX();
  const float right = left + ImGui::GetContentRegionAvail().x;
  const float gap = std::round(8 * s);
  const Initialization* result =
      input.inspection() ? input.inspection()->initialization.get() : nullptr;
  bool first = true;
  for (const ResultGroup& group :
       result_groups(input.inspection(), input.timings, input.state.document.cube_side)) {
    if (!first) ImGui::Dummy({1, 2 * s});
    heading(group.title.c_str());
    if (first) draw_state(input, right);
    if (group.title == kVerdictTitle && result && result->verdict)
      draw_verdict(*result, left, right, gap, s);
    if (group.title == "TIME") {
      draw_pairs(group, left, right, gap);
    } else {
      for (const ResultRow& row : group.rows) draw_row(row, left, right, gap);
    }
    first = false;
  }
  if (result && !result->ok && !(result->verdict && result->verdict->reason == result->reason)) {
    ImGui::PushTextWrapPos(right);
    ImGui::TextUnformatted(result->reason.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::PopStyleVar();
}

}  // namespace gpo
