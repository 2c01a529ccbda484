// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/tracks_in_view.h"

#include "engine/window/tracks.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace gpo {
namespace {

/// Those seen in the current frame for which `takes(frame in window, column)`.
template <class Takes>
std::vector<std::int64_t> tracks_if(const WorkbenchState& state, Takes&& takes) {
  std::vector<std::int64_t> ids;
  if (!state.results.inspection) return ids;
  const Tracks& tracks = *state.results.inspection->tracks;
  const int frame = state.view.frame - tracks.start;
  if (frame < 0 || frame >= tracks.frame_count()) return ids;
  for (int column = 0; column < tracks.track_count(); ++column)
    if (tracks.seen(frame, column) && takes(frame, column)) ids.push_back(tracks.ids[column]);
  std::ranges::sort(ids);
  return ids;
}

}  // namespace

std::vector<std::int64_t> tracks_of_window(const WorkbenchState& state) {
  if (!state.results.inspection) return {};
  std::vector<std::int64_t> ids = state.results.inspection->tracks->ids;
  std::ranges::sort(ids);
  return ids;
}

std::vector<std::int64_t> tracks_in_view(const WorkbenchState& state) {
  return tracks_if(state, [](int, int) { return true; });
}

std::vector<std::int64_t> outliers_in_view(const WorkbenchState& state) {
  return tracks_if(state, [&](int frame, int column) {
    return !state.results.inspection->window->inlier[frame][column];
  });
}

std::vector<std::int64_t> tracks_within(const WorkbenchState& state,
                                        const Eigen::Vector2d& a,
                                        const Eigen::Vector2d& b) {
  const Eigen::AlignedBox2d box(a.cwiseMin(b), a.cwiseMax(b));
  return tracks_if(state, [&](int frame, int column) {
    return box.contains(state.results.inspection->tracks->raw_px[frame].col(column).eval());
  });
}

std::optional<int> column_of(const Tracks& tracks, std::int64_t id) {
  const auto found = std::ranges::find(tracks.ids, id);
  if (found == tracks.ids.end()) return std::nullopt;
  return static_cast<int>(found - tracks.ids.begin());
}

}  // namespace gpo
