// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/inspection/studies/track_life.h"

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gpo {

/// A track of the window in the list of all.
struct TrackRow {
  std::int64_t id = 0;
  int seen = 0;                       ///< frames of the window that see it
  int inlier = 0;                     ///< frames in which it is an inlier of its plane
  std::optional<int> plane = {};      ///< counts from 1; nothing: it is on none
  std::optional<double> rms_px = {};  ///< of its residuals as an inlier of the leading plane
  std::optional<double> depth = {};   ///< in the reference camera [d]
  std::string verdict = {};           ///< one sentence
};

enum class TrackColumn { track, seen, inlier, plane, residual, depth, verdict };

/// By id.
std::vector<TrackRow> track_rows(const Inspection& inspection);

/// Unknown values last, whichever way; of equal ones the smaller id first.
void sort_tracks(std::vector<TrackRow>& rows, TrackColumn by, bool descending);

/// With a head that has units.
std::string to_csv(std::span<const TrackRow> rows);

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
