// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/inspection/studies/planes.h"
#include "engine/inspection/studies/track_life.h"
#include "ui/workbench/state.h"

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gpo {

/// A track in the list of the window's tracks.
struct TrackRow {
  std::int64_t id = 0;
  int seen = 0;                       ///< frames of the window with an observation
  int inlier = 0;                     ///< frames in which it is an inlier of its plane
  std::optional<int> plane = {};      ///< counts from 1; nullopt if it is on none
  std::optional<double> rms_px = {};  ///< residuals as an inlier of the leading plane
  std::optional<double> depth = {};   ///< in the reference camera [d]
  std::string verdict = {};           ///< one sentence
};

enum class TrackColumn { track, seen, inlier, plane, residual, depth, verdict };

/// Returns the rows in the order of the ids.
std::vector<TrackRow> track_rows(const Inspection& inspection);

/// Sorts; unknown values come last either way, and of equal ones the smaller id first.
void sort_tracks(std::vector<TrackRow>& rows, TrackColumn by, bool descending);

/// Returns a header with units and a line for each row.
std::string to_csv(std::span<const TrackRow> rows);

/// Caches the lives of the tracks that were requested last.
class TrackLives {
 public:
  /// Returns the life of a track by its column of the window; valid until the next call.
  const TrackLife& of(const Inspection& inspection, int column);
  /// Returns how many lives were computed so far.
  std::size_t computed() const { return computed_; }

 private:
  /// A life depends on these only, not on the cube.
  struct Entry {
    std::shared_ptr<const Tracks> tracks;
    std::shared_ptr<const Window> window;
    std::shared_ptr<const Initialization> initialization;
    int column;
    TrackLife life;
  };
  std::list<Entry> recent_;  ///< the last requested one first
  std::size_t computed_ = 0;
};

/// Returns one sentence on the decompositions of a frame's homography; there must be at least one.
std::string candidates_sentence(std::span<const HomographyCandidate> candidates);

/// Returns why a frame (counts in the window, may be outside of it) has no decompositions; empty if
/// it has some.
std::string why_no_candidates(const NormalStudy& study, int frame_in_window);

/// Returns normal, tilt, rotation, baseline, score and points behind a camera.
std::vector<std::string> candidate_cells(const HomographyCandidate& candidate);

/// Returns why there is no study of the shown window's normals; `doing` while it is computed, empty
/// if there is one.
std::string why_no_study(const WorkbenchState& state, const std::string& doing);

}  // namespace gpo
