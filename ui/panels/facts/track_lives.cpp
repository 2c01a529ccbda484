// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/track_lives.h"

#include <algorithm>

namespace gpo {

const TrackLife& TrackLives::of(const Inspection& inspection, int column) {
  constexpr std::size_t kMost = 16;  // a frame of the window shows three at most
  const auto found = std::ranges::find_if(recent_, [&](const Entry& entry) {
    return entry.column == column && entry.tracks == inspection.tracks &&
           entry.window == inspection.window && entry.initialization == inspection.initialization;
  });
  if (found != recent_.end()) {
    recent_.splice(recent_.begin(), recent_, found);
    return recent_.front().life;
  }
  ++computed_;
  recent_.push_front({inspection.tracks,
                      inspection.window,
                      inspection.initialization,
                      column,
                      track_life(inspection, column)});
  if (recent_.size() > kMost) recent_.pop_back();
  return recent_.front().life;
}

}  // namespace gpo
