// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/studies/track_life.h"

#include <cstddef>
#include <list>
#include <memory>

namespace gpo {

/// What is known of tracks, computed once each: those that were asked for last are kept.
class TrackLives {
 public:
  /// Of the track of a column of the window. Valid until others have been asked for.
  const TrackLife& of(const Inspection& inspection, int column);
  /// Counts what was computed.
  std::size_t computed() const { return computed_; }

 private:
  /// A life is what it is by these; an inspection whose cube was moved has the same.
  struct Entry {
    std::shared_ptr<const Tracks> tracks;
    std::shared_ptr<const Window> window;
    std::shared_ptr<const Initialization> initialization;
    int column;
    TrackLife life;
  };
  std::list<Entry> recent_;  ///< the last asked for first
  std::size_t computed_ = 0;
};

}  // namespace gpo
