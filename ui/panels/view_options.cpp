// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/view_options.h"

#include "ui/workbench/tracks_in_view.h"

#include <utility>

namespace gpo {

ImageViewOptions image_options(const WorkbenchState& state, const Inspection* inspection) {
  ImageViewOptions options;
  options.tracks = state.view.tracks;
  if (!state.view.tails) options.tail_frames = 0;
  options.residuals = state.view.residuals;
  options.cube = state.view.cube;
  options.cube_side = state.cube_side;
  options.truth = state.view.truth;
  options.legend = inspection != nullptr;
  return options;
}

SceneViewOptions scene_options(const WorkbenchState& state) {
  SceneViewOptions options;
  options.cube = state.view.cube;
  options.cube_side = state.cube_side;
  options.truth = state.view.truth;
  options.uncertainty = state.view.uncertainty;
  return options;
}

Highlight highlight_of(const WorkbenchState& state) {
  Highlight highlight;
  if (!state.inspection) return highlight;
  const Tracks& tracks = *state.inspection->tracks;
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

Inspection nothing_inspected(std::shared_ptr<const Recording> recording) {
  Inspection nothing;
  nothing.recording = std::move(recording);
  nothing.tracks = std::make_shared<const Tracks>();
  nothing.window = std::make_shared<const Window>();
  nothing.initialization = std::make_shared<const Initialization>();
  return nothing;
}

}  // namespace gpo
