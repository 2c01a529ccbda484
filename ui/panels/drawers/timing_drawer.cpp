// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/look/numbers.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/views/overlay/overlay.h"
#include "ui/workbench/compared.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

struct StageText {
  const char *title, *meaning;
  Role color;
};
constexpr std::array<StageText, 5> kStages = {
    {{"tracking", "Following corners from frame to frame", Role::tracking},
     {"RANSAC", "Homographies of all frames, and which tracks fit them", Role::ransac},
     {"rotations", "From the gyroscope or from the homographies", Role::rotations},
     {"initialization", "The method itself, its optimization aside", Role::initialization},
     {"optimization", "The method's iterative solver", Role::optimization}}};

/// Milliseconds, one a stage.
std::array<double, 5> stages_ms(const Timing& t) {
  return {t.track, t.ransac, t.rotations, std::max(0.0, t.initialize - t.optimize), t.optimize};
}

double sum_ms(const Timing& timing) {
  double sum = 0;
  for (const double stage : stages_ms(timing)) sum += stage;
  return sum;
}

/// The stages' names with their colors are the legend.
void header(float scale) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  colored_text(Role::text_dim, "[ms]");
  for (std::size_t i = 0; i < kStages.size(); ++i) {
    ImGui::TableNextColumn();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float side = 9 * scale, y = at.y + (ImGui::GetTextLineHeight() - side) / 2;
    ImGui::GetWindowDrawList()->AddRectFilled(
        {at.x, y}, {at.x + side, y + side}, imgui_color(kStages[i].color), 2 * scale);
    ImGui::SetCursorScreenPos({at.x + side + 5 * scale, at.y});
    colored_text(Role::text_dim, kStages[i].title);
    tooltip(kStages[i].meaning);
  }
  ImGui::TableNextColumn();
  colored_text(Role::text_dim, "sum");
  ImGui::TableNextColumn();
}

/// As wide as the column for `longest_ms`.
void draw_bar(const ShownResult& result, double longest_ms) {
  const auto stages = stages_ms(result.inspection->timing);
  const double sum = sum_ms(result.inspection->timing);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetTextLineHeight();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  double left = at.x;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const double right = left + width * stages[i] / longest_ms;
    const auto from = static_cast<float>(std::round(left));
    const auto to = static_cast<float>(std::round(right));
    left = right;
    if (to <= from) continue;
    list.AddRectFilled({from, at.y}, {to, at.y + height}, imgui_color(kStages[i].color));
    ImGui::SetCursorScreenPos({from, at.y});
    hit_area(kStages[i].title, {to - from, height});
    tooltip(fmt::format("{}, {}: {}, {:.0f} % of {}",
                        result.name,
                        kStages[i].title,
                        milliseconds_text(stages[i]),
                        100 * stages[i] / sum,
                        milliseconds_text(sum)));
  }
}

void draw_row(const ShownResult& result, double longest_ms, bool timings, float scale) {
  ImGui::TableNextRow();
  ImGui::PushID(&result);
  ImGui::TableNextColumn();
  marked_name(result.current ? Sign::disc : Sign::dot, result.rgb, result.name, scale);
  const auto number = [&](double ms) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(timings ? number_text(ms, 2).c_str() : "\u2013");
    if (!timings) tooltip("Times are left out of pictures, so that these compare");
  };
  for (const double stage : stages_ms(result.inspection->timing)) number(stage);
  number(sum_ms(result.inspection->timing));
  ImGui::TableNextColumn();
  if (timings && longest_ms > 0) draw_bar(result, longest_ms);
  ImGui::PopID();
}

float widest_name_px(const std::vector<ShownResult>& shown) {
  float widest = 0;
  for (const ShownResult& result : shown)
    widest = std::max(widest, ImGui::CalcTextSize(result.name.c_str()).x);
  return widest;
}

}  // namespace

void timing_drawer(const PanelInput& input,
                   const Rectangle& place,
                   Views& /*views*/,
                   Commands& /*commands*/) {
  const std::vector<ShownResult> shown = shown_results(input.state);
  if (shown.empty()) return draw_empty(place, "Times appear when the window is computed");
  double longest_ms = 0;
  for (const ShownResult& result : shown)
    longest_ms = std::max(longest_ms, sum_ms(result.inspection->timing));
  const float s = input.scale;
  ImGui::SetCursorScreenPos({place.x + 12 * s, place.y + 8 * s});
  constexpr int kColumns = static_cast<int>(kStages.size()) + 3;
  const auto flags = ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollY;
  const ImVec2 size(place.width - 24 * s, place.bottom() - place.y - 12 * s);
  if (!ImGui::BeginTable("timing", kColumns, flags, size)) return;
  // Widths that do not depend on what was drawn before, as contents and their sizes come later.
  const auto fixed = [](float width) {
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, width);
  };
  fixed(widest_name_px(shown) + 20 * s);
  for (const auto& stage : kStages) fixed(ImGui::CalcTextSize(stage.title).x + 16 * s);
  fixed(56 * s);
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupScrollFreeze(0, 1);
  header(s);
  for (const ShownResult& result : shown) draw_row(result, longest_ms, input.timings, s);
  ImGui::EndTable();
}

}  // namespace gpo
