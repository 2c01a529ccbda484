// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/window/window.h"

#include <algorithm>

namespace gpo {

int Window::inlier_count(int frame) const {
  return static_cast<int>(std::ranges::count(inlier[frame], true));
}

std::vector<int> Window::inlier_tracks(int frame) const {
  std::vector<int> tracks;
  for (int j = 0; j < track_count(); ++j) {
    if (inlier[frame][j]) tracks.push_back(j);
  }
  return tracks;
}

bool Window::is_inlier_track(int track) const {
  int seen = 0;
  int agreeing = 0;
  for (int i = 1; i < frame_count(); ++i) {
    seen += points_px[i].col(track).allFinite() ? 1 : 0;
    agreeing += inlier[i][track] ? 1 : 0;
  }
  return agreeing > 0 && 2 * agreeing >= seen;
}

std::optional<int> Window::plane_of(int track) const {
  for (int k = 0; k < static_cast<int>(planes.size()); ++k)
    if (std::ranges::binary_search(planes[k].tracks, track)) return k;
  return std::nullopt;
}

}  // namespace gpo
