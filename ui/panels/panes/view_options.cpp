// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panes/view_options.h"

#include "engine/base/error.h"
#include "engine/window/tracks.h"
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/panels.h"
#include "ui/views/model/solid_model.h"
#include "ui/views/overlay/overlay.h"
#include "ui/views/overlay/track_colors.h"
#include "ui/workbench/state.h"

#include <cmath>

#include <imgui.h>

namespace gpo {

namespace {

/// Of the inspection that the state shows; computed anew where it is another.
std::shared_ptr<const TrackColors> colors_of(const WorkbenchState& state, KeptTrackColors& kept) {
  if (kept.of != state.results.inspection || kept.coloring != state.view.coloring) {
    kept = {state.results.inspection, state.view.coloring, nullptr};
    if (state.results.inspection)
      kept.colors = track_colors(*state.results.inspection, state.view.coloring);
  }
  return kept.colors;
}

/// The state's model; read anew where it is another.
const CachedModel& model_of(const WorkbenchState& state, CachedModel& kept) {
  if (kept.name == state.document.model) return kept;
  kept = {state.document.model, nullptr, {}};
  if (state.document.model.empty()) return kept;
  try {
    kept.model = std::make_shared<const SolidModel>(read_solid_model(state.document.model));
  } catch (const InputError& error) {
    kept.error = error.what();
  }
  return kept;
}

constexpr double kTowerSides = 5;

double height_sides(const WorkbenchState& state, const CachedModel& kept) {
  if (kept.model) return kept.model->height_sides;
  return state.view.toggles.tower ? kTowerSides : 1;
}

}  // namespace

ViewOptions view_options(const WorkbenchState& state, Views& views) {
  const CachedModel& model = model_of(state, views.model);
  ViewOptions options{.show = state.view.toggles,
                      .cube_side = state.document.cube_side,
                      .cube_height_sides = height_sides(state, model),
                      .model = model.model,
                      .model_error = model.error,
                      .colors = colors_of(state, views.colors)};
  options.show.legend &= state.results.inspection != nullptr;
  return options;
}

std::vector<CompareColumn> compare_columns(const std::vector<Compared>& results) {
  std::vector<CompareColumn> columns;
  columns.reserve(results.size());
  for (const Compared& one : results)
    columns.push_back({one.configuration,
                       one.inspection,
                       one.inspection      ? ""
                       : one.error.empty() ? "computing"
                                           : one.error});
  return columns;
}

WorkbenchState showing(const WorkbenchState& state, const Compared& other) {
  WorkbenchState shown = state;
  shown.results.inspection = other.inspection;
  return shown;
}

void draw_flip_label(ImDrawList& list, const ScreenRect& rect, const Compared& other) {
  const float s = overlay_scale();
  std::string text = title_of(other.configuration);
  if (!other.inspection)
    text += other.error.empty() ? ": computing" : ": not computed, " + other.error;
  const ImFont* bold = font(Font::bold);
  const ImVec2 size = bold->CalcTextSizeA(bold->FontSize, 1e6F, 0, text.c_str());
  const float width = size.x + 34 * s, height = size.y + 12 * s;
  const ImVec2 corner = to_imgui(rect.min + Eigen::Vector2d(rect.size.x(), 0));
  const ImVec2 at(std::round(corner.x - width - 10 * s), std::round(corner.y + 10 * s));
  const ImVec2 end(at.x + width, at.y + height);
  const std::uint32_t rgb = color_of(other.configuration);
  list.AddRectFilled(at, end, imgui_color(Role::background, 0.88), 5 * s);
  list.AddRect(at, end, imgui_color(rgb), 5 * s, 0, 1.5F * s);
  list.AddRectFilled(
      at, {at.x + 8 * s, end.y}, imgui_color(rgb), 5 * s, ImDrawFlags_RoundCornersLeft);
  write_text(list, Font::bold, {at.x + 20 * s, at.y + 6 * s}, text);
}

Highlight highlight_of(const WorkbenchState& state) {
  Highlight highlight;
  if (!state.results.inspection) return highlight;
  const Tracks& tracks = *state.results.inspection->tracks;
  for (const std::int64_t id : state.selection.tracks)
    if (const auto column = column_of(tracks, id)) highlight.picked.push_back(*column);
  if (state.selection.focus) highlight.focus = column_of(tracks, *state.selection.focus);
  if (state.hover.track) highlight.hovered = column_of(tracks, *state.hover.track);
  if (state.hover.camera) highlight.camera = *state.hover.camera - tracks.start;
  return highlight;
}

bool room_for_legend(const Rectangle& place, float scale) {
  return place.width >= 300 * scale && place.height >= 240 * scale;
}

ScreenRect screen_rect(const Rectangle& place) {
  return {{place.x, place.y}, {place.width, place.height}};
}

}  // namespace gpo
