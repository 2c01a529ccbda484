// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/state.h"

#include <algorithm>
#include <set>

namespace gpo {

bool Selection::contains(std::int64_t track) const {
  return std::ranges::binary_search(tracks, track);
}

Selection selected(std::span<const std::int64_t> tracks) { return extended({}, tracks); }

Selection toggled(Selection selection, std::int64_t track) {
  if (!selection.contains(track)) return extended(selection, {&track, 1});
  std::erase(selection.tracks, track);
  if (selection.focus == track) {
    selection.focus = std::nullopt;
    if (!selection.tracks.empty()) selection.focus = selection.tracks.back();
  }
  return selection;
}

Selection extended(Selection selection, std::span<const std::int64_t> tracks) {
  std::set<std::int64_t> all(selection.tracks.begin(), selection.tracks.end());
  all.insert(tracks.begin(), tracks.end());
  selection.tracks.assign(all.begin(), all.end());
  if (!tracks.empty()) selection.focus = tracks.back();
  return selection;
}

Selection inverted(const Selection& selection, std::span<const std::int64_t> all) {
  std::vector<std::int64_t> others;
  for (const std::int64_t track : all)
    if (!selection.contains(track)) others.push_back(track);
  return selected(others);
}

void pick_point(WorkbenchState& state, const Vector2d& raw_px) {
  Selection& selection = state.selection;
  if (selection.points_px.size() != 1 || selection.points_frame != state.view.frame)
    selection.points_px.clear();
  selection.points_frame = state.view.frame;
  selection.points_px.push_back(raw_px);
  say(state,
      selection.points_px.size() == 1
          ? "first point picked; Alt+click the second one"
          : "two points picked; right-click the image to set their distance or the origin");
}

void close_next(WorkbenchState& state) {
  Panes& panes = state.view.panes;
  if (state.view.drawn_mask)
    state.view.drawn_mask.reset();
  else if (!state.selection.tracks.empty() || !state.selection.points_px.empty())
    state.selection = {};
  else if (panes.beside != nullptr)
    panes.beside = nullptr;
  else
    panes.drawer = nullptr;
}

}  // namespace gpo
