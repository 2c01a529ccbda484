// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/theme.h"
#include "ui/panels/drawers/chart_item.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/workbench/state.h"

#include <cmath>

namespace gpo {
namespace {

/// The one that the mouse rests on, wherever, else the one that was picked last; null: none.
const TrackLife* focused_track(const PanelInput& input, Views& views) {
  const WorkbenchState& state = input.state;
  const auto& focus = state.hover.track ? state.hover.track : state.selection.focus;
  if (!focus) return nullptr;
  const auto column = column_of(*input.inspection()->tracks, *focus);
  return column ? &views.lives.of(*input.inspection(), *column) : nullptr;
}

/// Computes them once an inspection.
const WindowResiduals& update(Residuals& residuals,
                              const std::shared_ptr<const Inspection>& inspection) {
  if (residuals.of == inspection) return residuals.px;
  residuals.of = inspection;
  residuals.px = window_residuals(*inspection);
  return residuals.px;
}

void draw_rms(const PanelInput& input,
              const Rectangle& place,
              const WindowResiduals& residuals,
              Views& views,
              Commands& commands) {
  const Chart chart = rms_chart(residuals, *input.inspection(), focused_track(input, views));
  const ChartItem item = chart_item("rms over frames", place, views, chart);
  drag_frame(item, input.state, 0, color_of(Role::accent), commands);
}

}  // namespace

void residuals_drawer(const PanelInput& input,
                      const Rectangle& place,
                      Views& views,
                      Commands& commands) {
  const Inspection* inspection = input.inspection();
  if (inspection == nullptr)
    return draw_empty(place, "Residuals appear when the window is initialized");
  if (!inspection->initialization->ok)
    return draw_empty(
        place, "No plane and no poses, so no residuals: " + inspection->initialization->reason);
  const WindowResiduals& residuals = update(views.residuals, input.state.results.inspection);
  const float left = std::floor(0.4F * place.width);
  chart_item("histogram of residuals",
             {place.x, place.y, left, place.height},
             views,
             residual_histogram(residuals, *inspection, input.state.view.frame));
  draw_rms(input,
           {place.x + left, place.y, place.width - left, place.height},
           residuals,
           views,
           commands);
}

}  // namespace gpo
