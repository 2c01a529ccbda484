// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/candidate_facts.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/views/overlay/overlay.h"
#include "ui/workbench/compared.h"

#include <cmath>

namespace gpo {
namespace {

using Eigen::Vector2d;

std::vector<NormalAnswer> answers(const WorkbenchState& state) {
  std::vector<NormalAnswer> all;
  for (const ShownResult& result : shown_results(state))
    if (result.inspection->initialization->ok)
      all.push_back({result.name, result.rgb, result.inspection, result.current});
  return all;
}

/// Wheel zooms around the pointer, drag moves, double click shows all.
void zoom_and_pan(const ScreenRect& rect, const NormalsZoom& zoom, Commands& commands) {
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
    const double by = std::pow(1.25, io.MouseWheel);
    push(commands, ZoomNormals{zoom_about(zoom, rect, {io.MousePos.x, io.MousePos.y}, by)});
  }
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0))
    return push(commands, ZoomNormals{});
  const Vector2d by(io.MouseDelta.x, io.MouseDelta.y);
  if (ImGui::IsItemActive() && !by.isZero()) push(commands, ZoomNormals{pan(zoom, rect, by)});
}

}  // namespace

void normals_pane(const PanelInput& input,
                  const Rectangle& place,
                  Views& views,
                  Commands& commands) {
  const WorkbenchState& state = input.state;
  if (!input.inspection())
    return draw_empty(place, "The sphere of normals appears when the window is computed");
  const std::string why = why_no_study(state, "Computing what a plane of each normal costs \u2026");
  if (!why.empty()) return draw_empty(place, why);
  hit_area("normals", {place.width, place.height});
  const ScreenRect rect{{place.x, place.y}, {place.width, place.height}};
  const ScreenRect inner = disc_rect(rect);
  const NormalsContent content{
      *input.inspection(), state.results.study, answers(state), state.view.frame};
  draw_normals_view(
      *ImGui::GetWindowDrawList(), rect, views.normals, content, state.view.normals_zoom);
  zoom_and_pan(inner, state.view.normals_zoom, commands);
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const Vector2d within = Vector2d(mouse.x, mouse.y) - inner.min;
  const bool over = (within.array() >= 0).all() && (within.array() < inner.size.array()).all();
  if (!ImGui::IsItemHovered() || ImGui::IsItemActive() || !over) return;
  const DiscMapping to = map_disc(inner, state.view.normals_zoom);
  const std::string text = normal_text(views.normals, content, to.to_disc({mouse.x, mouse.y}));
  if (!text.empty()) show_tooltip(text);
}

}  // namespace gpo
