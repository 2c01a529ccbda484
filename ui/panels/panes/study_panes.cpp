// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Panes of normals, of decompositions of homographies, and of the solvers' iterations.
#include "engine/base/error.h"
#include "engine/geometry/pose.h"
#include "ui/panels/panels.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr const char* kDash = "\u2013";

constexpr ColumnText kDecompositionColumns[] = {
    {"verdict", "Feasible, or the reason for rejection"},
    {"normal (x, y, z)", "Unit normal of the plane, in the reference camera"},
    {"tilt [\u00b0]", "Angle between normal and optical axis; 0: the plane faces the camera"},
    {"rotation [\u00b0]", "Angle of the camera's rotation since the reference frame"},
    {"|t| [d]", "Baseline: distance to the reference camera, in plane distances d"},
    {"score [\u00b0]", "Angle between this rotation and the given one; smaller is better"},
    {"behind", "Inliers behind a camera (chirality), of all"}};

constexpr ColumnText kSolverColumns[] = {
    {"method", "The current result, and the compared ones"},
    {"cost [px\u00b2]", "Half the weighted sum of squared residuals, at the start and at the end"},
    {"it.", "Iterations; \"42 of 110\" if the others belong to attempts that were discarded"},
    {"unknowns", "Parameters of the optimization"},
    {"residuals", "Scalar residuals: two for each observation"},
    {"ended by", "Why the solver stopped"},
    {"time [ms]", "Time of the optimization alone"}};

std::vector<ShownResult> answers(const WorkbenchState& state) {
  std::vector<ShownResult> all = shown_results(state);
  std::erase_if(all, [](const auto& one) { return !one.inspection->initialization->ok; });
  return all;
}

void zoom_and_pan(const ScreenRect& rect, const NormalsZoom& zoom, Commands& commands) {
  if (const double by = wheel_zoom(); by != 1)
    push(commands, ZoomNormals{zoom_about(zoom, rect, mouse_px(), by)});
  if (is_item_double_clicked()) return push(commands, ZoomNormals{});
  const Vector2d drag = drag_px();
  if (!drag.isZero()) push(commands, ZoomNormals{pan(zoom, rect, drag)});
}

void draw_decomposition(const HomographyCandidate& candidate, float scale) {
  const bool accepted = candidate.taken();
  ImGui::TableNextRow();
  ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(accepted ? Role::text : Role::text_dim));
  ImGui::TableNextColumn();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  sign_at_cursor(accepted ? Sign::circle : Sign::cross,
                 color_of(accepted ? Role::inlier : Role::outlier));
  ImGui::SetCursorScreenPos({at.x + 20 * scale, at.y});
  ImGui::TextUnformatted(accepted ? "feasible" : candidate.rejected.c_str());
  for (const std::string& cell : candidate_cells(candidate)) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(cell.c_str());
  }
  ImGui::PopStyleColor();
}

/// Scrolls sideways in a narrow pane.
void draw_decompositions(const std::vector<HomographyCandidate>& all, ImVec2 size, float scale) {
  const auto flags = ImGuiTableFlags_ScrollX | ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg |
                     ImGuiTableFlags_SizingFixedFit;
  const int columns = static_cast<int>(std::size(kDecompositionColumns));
  ImGui::PushFont(font(Font::small));
  if (ImGui::BeginTable("decompositions", columns, flags, size)) {
    frozen_header(kDecompositionColumns);
    for (const HomographyCandidate& candidate : all) draw_decomposition(candidate, scale);
    ImGui::EndTable();
  }
  ImGui::PopFont();
}

const char* ended_by(Termination termination) {
  if (termination == Termination::convergence) return "converged";
  return termination == Termination::no_convergence ? "limit" : to_string(termination);
}

std::vector<std::string> solver_cells(const ShownResult& result, bool timings) {
  const SolverReport& solver = result.inspection->initialization->solver;
  if (solver.unknowns == 0) return {kDash, kDash, kDash, kDash, "not optimized", kDash};
  return {fmt::format("{:.4g} \u2192 {:.4g}", solver.initial_cost, solver.final_cost),
          iterations_text(solver),
          std::to_string(solver.unknowns),
          std::to_string(solver.residuals),
          ended_by(solver.termination),
          timings ? number_text(solver.milliseconds, 2) : kDash};
}

void draw_solver(const ShownResult& result, bool timings, float scale) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  marked_name(result.current ? Sign::disc : Sign::dot, result.rgb, result.name, scale);
  const Initialization& found = *result.inspection->initialization;
  const auto [unknowns, residuals] = std::pair(found.solver.unknowns, found.solver.residuals);
  const std::string rms = number_text(found.transfer_rms_px.value_or(NAN), 3);
  tooltip(found.ok ? fmt::format(
                         "{} unknowns, {} residuals, transfer RMS {} px", unknowns, residuals, rms)
                   : "Failed: " + found.reason);
  for (const std::string& text : solver_cells(result, timings))
    if (ImGui::TableNextColumn()) ImGui::TextUnformatted(text.c_str());
}

void draw_solvers(const PanelInput& input, const std::vector<ShownResult>& shown, float width) {
  const auto flags = ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoPadOuterX;
  const int columns = static_cast<int>(std::size(kSolverColumns));
  ImGui::PushFont(font(Font::small));
  if (ImGui::BeginTable("facts", columns, flags, {width, 0})) {
    // A narrow pane has no room for the counts, which are in the tooltip, too.
    const bool wide = width > 520 * input.scale;
    for (int i = 0; i < columns; ++i)
      ImGui::TableSetupColumn(kSolverColumns[i].title,
                              wide || (i != 3 && i != 4) ? 0 : ImGuiTableColumnFlags_Disabled);
    table_header(kSolverColumns);
    for (const ShownResult& result : shown) draw_solver(result, input.timings, input.scale);
    ImGui::EndTable();
  }
  ImGui::PopFont();
}

/// Returns why the current result has no iterations; empty if it has some.
std::string why_no_trace(const ShownResult& current) {
  const Initialization& initialization = *current.inspection->initialization;
  if (!initialization.solver.trace.empty()) return "";
  if (!initialization.ok)
    return fmt::format(
        "{} failed before the optimization: {}", current.name, initialization.reason);
  return current.name + " has a closed-form solution and does not optimize";
}

/// One below the other if the place is high enough, else side by side.
void draw_charts(const PanelContext& ui,
                 const Rectangle& place,
                 const std::array<Chart, 3>& charts) {
  const int rows = place.height >= 3 * 92 * ui.scale ? 3 : 1;
  const int columns = rows == 3 ? 1 : 3;
  const float width = std::floor(place.width / static_cast<float>(columns));
  const float height = std::floor(place.height / static_cast<float>(rows));
  for (int i = 0; i < 3; ++i) {
    Chart chart = charts[i];
    if (columns == 3) chart.y_label = chart.y_label.substr(chart.y_label.find('['));
    const float x = place.x + width * static_cast<float>(i % columns);
    const float y = place.y + height * static_cast<float>(i / columns);
    chart_item(fmt::format("solver {}", i), {x, y, width, height}, ui.views, chart, false);
  }
}

}  // namespace

std::string candidates_sentence(std::span<const HomographyCandidate> candidates) {
  std::vector<const HomographyCandidate*> accepted;
  for (const HomographyCandidate& candidate : candidates)
    if (candidate.taken()) accepted.push_back(&candidate);
  const std::string all = counted(candidates.size(), "decomposition");
  if (accepted.empty()) return fmt::format("none of {} is feasible.", all);
  const double tilt = angle_deg(accepted[0]->motion.normal, {0, 0, -1});
  if (accepted.size() == 1)
    return fmt::format("1 of {} is feasible: a plane tilted by {:.1f}\u00b0.", all, tilt);
  double apart = 0;
  for (const HomographyCandidate* one : accepted)
    for (const HomographyCandidate* other : accepted)
      apart = std::max(apart, angle_deg(one->motion.normal, other->motion.normal));
  return fmt::format(
      "{} of {} are feasible; their normals are {:.1f}\u00b0 apart. This frame alone is ambiguous.",
      accepted.size(),
      all,
      apart);
}

std::string why_no_candidates(const NormalStudy& study, int frame_in_window) {
  const int frames = static_cast<int>(study.candidates.size());
  if (frame_in_window < 0 || frame_in_window >= frames)
    return "This frame is outside of the window. Go to one of the bars of the time line";
  if (frame_in_window == 0)
    return "This is the reference frame. Homographies map it to the other frames";
  if (study.candidates[frame_in_window].empty())
    return "This frame has no homography that can be decomposed: it has too few inliers, or the "
           "camera only rotated";
  return "";
}

std::vector<std::string> candidate_cells(const HomographyCandidate& candidate) {
  const Vector3d& n = candidate.motion.normal;
  return {fmt::format("{:.3f}, {:.3f}, {:.3f}", n.x(), n.y(), n.z()),
          fmt::format("{:.1f}", angle_deg(n, {0, 0, -1})),
          fmt::format("{:.2f}", degrees(so3_log(candidate.motion.R_21).norm())),
          fmt::format("{:.3f}", candidate.motion.tau.norm()),
          fmt::format("{:.2f}", candidate.score),
          fmt::format("{} of {}", candidate.behind, candidate.of)};
}

std::string why_no_study(const WorkbenchState& state, const std::string& doing) {
  const auto& [inspection, study] = std::tie(state.results.inspection, state.results.study);
  if (!study || !inspection || study->window != inspection->window) return doing;
  return study->error.empty() ? "" : "Cannot analyze the normals of the window: " + study->error;
}

void normals_pane(const PanelContext& ui, const Rectangle& place) {
  const WorkbenchState& state = ui.state;
  if (!ui.inspection())
    return draw_empty(place, "The sphere of normals appears when the window is computed");
  const std::string why = why_no_study(state, "Computing the cost of each plane normal \u2026");
  if (!why.empty()) return draw_empty(place, why);
  hit_area("normals", {place.width, place.height});
  const ScreenRect rect = screen_rect(place);
  const ScreenRect inner = disc_rect(rect);
  const NormalsContent content{
      *ui.inspection(), state.results.study, answers(state), state.view.frame};
  draw_normals_view(
      {*ImGui::GetWindowDrawList(), rect}, ui.views.normals, content, state.view.normals_zoom);
  zoom_and_pan(inner, state.view.normals_zoom, ui.commands);
  const Vector2d within = mouse_px() - inner.min;
  const bool over = (within.array() >= 0).all() && (within.array() < inner.size.array()).all();
  if (!ImGui::IsItemHovered() || ImGui::IsItemActive() || !over) return;
  const DiscMapping to = map_disc(inner, state.view.normals_zoom);
  const std::string text = normal_text(ui.views.normals, content, to.to_disc(mouse_px()));
  if (!text.empty()) show_tooltip(text);
}

void candidates_pane(const PanelContext& ui, const Rectangle& place) {
  const WorkbenchState& state = ui.state;
  if (!ui.inspection())
    return draw_empty(
        place, "The decompositions of the frame's homography appear when the window is computed");
  std::string why = why_no_study(state, "Decomposing the homographies of all frames \u2026");
  if (!why.empty()) return draw_empty(place, why);
  const int frame = state.view.frame - state.results.study->window->start;
  why = why_no_candidates(*state.results.study, frame);
  if (!why.empty()) return draw_empty(place, why);
  const std::vector<HomographyCandidate>& candidates = state.results.study->candidates[frame];
  const float s = ui.scale, inset = 12 * s;
  ImGui::SetCursorScreenPos({place.x + inset, place.y + 8 * s});
  ImGui::BeginGroup();
  wrapped_text(fmt::format("Frame {}: {}", state.view.frame, candidates_sentence(candidates)),
               ImGui::GetCursorPosX() + place.width - 2 * inset);
  ImGui::EndGroup();
  const float top = ImGui::GetItemRectMax().y + 8 * s;
  ImGui::SetCursorScreenPos({place.x + inset, top});
  draw_decompositions(candidates, {place.width - 2 * inset, place.bottom() - top - 4 * s}, s);
}

void solver_pane(const PanelContext& ui, const Rectangle& place) {
  const std::vector<ShownResult> shown = shown_results(ui.state);
  if (shown.empty())
    return draw_empty(place, "The solver's iterations appear when the window is initialized");
  const std::string missing = why_no_trace(shown.front());
  const auto charts = solver_charts(shown);
  if (charts.front().curves.empty()) return draw_empty(place, missing);
  const float s = ui.scale, inset = 12 * s;
  ImGui::SetCursorScreenPos({place.x + inset, place.y + 8 * s});
  ImGui::BeginGroup();
  if (!missing.empty()) clipped_text(missing, place.width - 2 * inset, color_of(Role::warning));
  draw_solvers(ui, shown, place.width - 2 * inset);
  ImGui::EndGroup();
  const float top = ImGui::GetItemRectMax().y + 6 * s;
  draw_charts(ui, {place.x, top, place.width, place.bottom() - top}, charts);
}

}  // namespace gpo
