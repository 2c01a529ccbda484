// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/selection.h"

#include <algorithm>

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

Selection extended(const Selection& selection, std::span<const std::int64_t> tracks) {
  Selection all = selection;
  all.tracks.insert(all.tracks.end(), tracks.begin(), tracks.end());
  std::ranges::sort(all.tracks);
  all.tracks.erase(std::unique(all.tracks.begin(), all.tracks.end()), all.tracks.end());
  if (!tracks.empty()) all.focus = tracks.back();
  return all;
}

Selection inverted(const Selection& selection, std::span<const std::int64_t> all) {
  std::vector<std::int64_t> others;
  for (const std::int64_t track : all)
    if (!selection.contains(track)) others.push_back(track);
  return selected(others);
}

}  // namespace gpo
