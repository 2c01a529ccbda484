// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/look/numbers.h"
#include "ui/panels/drawers/chart_item.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/views/charts/study_charts.h"
#include "ui/views/overlay/overlay.h"
#include "ui/workbench/compared.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr const char* kDash = "\u2013";

constexpr ColumnText kFactColumns[] = {
    {"method", "The current result, and those that it is compared with"},
    {"cost [px\u00b2]",
     "Half the sum of squared residuals, as the solver weighs them: at its start "
     "and at its end"},
    {"it.", "Iterations"},
    {"unknowns", "Parameters that the solver moves"},
    {"residuals", "Scalar residuals: two an observation"},
    {"ended by", "What stopped it"},
    {"time [ms]", "Of the optimization alone"}};

const char* ended_by(Termination termination) {
  if (termination == Termination::convergence) return "converged";
  return termination == Termination::no_convergence ? "limit" : to_string(termination);
}

std::vector<std::string> cells(const ShownResult& result, bool timings) {
  const SolverReport& solver = result.inspection->initialization->solver;
  if (solver.unknowns == 0) return {kDash, kDash, kDash, kDash, "not optimized", kDash};
  return {fmt::format("{:.4g} \u2192 {:.4g}", solver.initial_cost, solver.final_cost),
          std::to_string(solver.iterations),
          std::to_string(solver.unknowns),
          std::to_string(solver.residuals),
          ended_by(solver.termination),
          timings ? number_text(solver.milliseconds, 2) : kDash};
}

/// Where there is little room, the counts are left to the tooltip.
bool is_shown(std::size_t column, bool wide) { return wide || (column != 3 && column != 4); }

void header(bool wide) {
  for (std::size_t i = 0; i < std::size(kFactColumns); ++i)
    ImGui::TableSetupColumn(kFactColumns[i].title,
                            is_shown(i, wide) ? 0 : ImGuiTableColumnFlags_Disabled);
  table_header(kFactColumns);
}

void draw_row(const ShownResult& result, bool timings, float scale) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  marked_name(result.current ? Sign::disc : Sign::dot, result.rgb, result.name, scale);
  const Initialization& made = *result.inspection->initialization;
  tooltip(made.ok ? fmt::format("{} unknowns, {} residuals, RMS {} px",
                                made.solver.unknowns,
                                made.solver.residuals,
                                number_text(made.rms_px, 3))
                  : "Failed: " + made.reason);
  for (const std::string& text : cells(result, timings))
    if (ImGui::TableNextColumn()) ImGui::TextUnformatted(text.c_str());
}

void draw_facts(const std::vector<ShownResult>& shown, float width, bool timings, float scale) {
  const bool wide = width > 520 * scale;
  ImGui::PushFont(font(Font::small));
  const auto flags = ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoPadOuterX;
  if (ImGui::BeginTable("facts", static_cast<int>(std::size(kFactColumns)), flags, {width, 0})) {
    header(wide);
    for (const ShownResult& result : shown) draw_row(result, timings, scale);
    ImGui::EndTable();
  }
  ImGui::PopFont();
}

/// What is to be said of a current result that iterated nothing; empty of one that did.
std::string why_no_trace(const ShownResult& current) {
  const Initialization& made = *current.inspection->initialization;
  if (!made.solver.trace.empty()) return "";
  if (!made.ok) return fmt::format("{} failed before it optimized: {}", current.name, made.reason);
  return current.name + " computes its answer directly: nothing is optimized";
}

/// One below the other where there is height for it, else side by side.
void draw_charts(const Rectangle& place,
                 const std::array<Chart, 3>& charts,
                 Views& views,
                 float scale) {
  const int rows = place.height >= 3 * 92 * scale ? 3 : 1;
  const int columns = rows == 3 ? 1 : 3;
  const float width = std::floor(place.width / static_cast<float>(columns));
  const float height = std::floor(place.height / static_cast<float>(rows));
  for (int i = 0; i < 3; ++i) {
    Chart chart = charts[i];
    if (columns == 3) chart.y_label = chart.y_label.substr(chart.y_label.find('['));
    const int row = i / columns;
    chart_item(fmt::format("solver {}", i),
               {place.x + width * static_cast<float>(i % columns),
                place.y + height * static_cast<float>(row),
                width,
                height},
               views,
               chart,
               false);
  }
}

}  // namespace

void solver_pane(const PanelInput& input,
                 const Rectangle& place,
                 Views& views,
                 Commands& /*commands*/) {
  const std::vector<ShownResult> shown = shown_results(input.state);
  if (shown.empty())
    return draw_empty(place, "The solver's iterations appear when the window is initialized");
  const std::string missing = why_no_trace(shown.front());
  std::vector<SolverRun> runs;
  // The current one last: over the others.
  for (auto result = shown.rbegin(); result != shown.rend(); ++result)
    runs.push_back({result->name, result->rgb, &result->inspection->initialization->solver});
  const auto has_trace = [](const SolverRun& run) { return !run.report->trace.empty(); };
  if (std::ranges::none_of(runs, has_trace)) return draw_empty(place, missing);
  const float s = input.scale, inset = 12 * s;
  ImGui::SetCursorScreenPos({place.x + inset, place.y + 8 * s});
  ImGui::BeginGroup();
  if (!missing.empty()) clipped_text(missing, place.width - 2 * inset, color_of(Role::warning));
  draw_facts(shown, place.width - 2 * inset, input.timings, s);
  ImGui::EndGroup();
  const float top = ImGui::GetItemRectMax().y + 6 * s;
  draw_charts({place.x, top, place.width, place.bottom() - top}, solver_charts(runs), views, s);
}

}  // namespace gpo
