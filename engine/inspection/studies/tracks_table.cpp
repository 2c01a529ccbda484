// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/tracks_table.h"

#include "engine/inspection/studies/track_life.h"
#include "engine/window/tracks.h"
#include "engine/window/window.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace gpo {
namespace {

/// Of each track, the number of its plane as a cell.
std::vector<std::string> plane_cells(const Window& window) {
  std::vector<std::string> cells(window.track_count());
  for (std::size_t k = 0; k < window.planes.size(); ++k)
    for (const int j : window.planes[k].tracks) cells[j] = std::to_string(k + 1);
  return cells;
}

/// Cells are told apart by commas, and sentences have some.
std::string cell(std::string text) {
  std::ranges::replace(text, ',', ';');
  return text;
}

/// What holds a track against its plane in one frame, else over the window; in the last frame that
/// sees it, also why it was lost.
std::string reason_in(const TrackFrame& seen,
                      const TrackLife& life,
                      const std::string& loss,
                      double threshold_px) {
  const bool far = seen.transfer_px && *seen.transfer_px > threshold_px;
  if (!seen.inlier && !far) return life.verdict;
  std::string reason;
  if (far) {
    reason =
        fmt::format("transfer error {:.1f} px above {:.1f} px", *seen.transfer_px, threshold_px);
  }
  if (&seen != &life.frames.back() || loss.empty()) return reason;
  return reason + (reason.empty() ? "" : "; ") + loss;
}

std::string loss_of(const Tracks& tracks, int column) {
  if (tracks.ends.empty() || !tracks.ends[column]) return "";
  const TrackEnd& end = *tracks.ends[column];
  return fmt::format("lost in frame {}: {}", tracks.start + end.frame, reason_of(end));
}

}  // namespace

std::string tracks_csv(const Inspection& inspection) {
  const Tracks& tracks = *inspection.tracks;
  const Window& window = *inspection.window;
  const double threshold_px = inspection.settings.options.ransac_threshold_px;
  const auto planes = plane_cells(window);
  std::string csv = "#frame,track,x,y,plane,verdict,residual_px,reason\n";
  for (int column = 0; column < tracks.track_count(); ++column) {
    TrackLife life = track_life(inspection, column);
    const bool on_plane = window.is_inlier_track(column);
    const std::string loss = loss_of(tracks, column);
    for (TrackFrame& seen : life.frames) {
      if (seen.frame == window.start) seen.inlier = on_plane;
      csv += fmt::format("{},{},{},{},{},{},{},{}\n",
                         seen.frame,
                         life.id,
                         seen.raw_px.x(),
                         seen.raw_px.y(),
                         planes[column],
                         seen.inlier ? "inlier" : "outlier",
                         seen.residual_px ? fmt::format("{:.4f}", *seen.residual_px) : "",
                         cell(reason_in(seen, life, loss, threshold_px)));
    }
  }
  return csv;
}

}  // namespace gpo
