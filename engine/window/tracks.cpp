// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/window/tracks.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace gpo {
namespace {

constexpr double kUnseen = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::vector<int> ambiguous_frames(const Repetition& repetition) {
  const auto& margins = repetition.margins;
  const auto distinct = [&](int i) {
    return i >= 1 && i < std::ssize(margins) && margins[i] >= kDistinctMotion &&
           std::isfinite(margins[i]);
  };
  std::vector<int> frames;
  for (int i = 1; i < std::ssize(margins); ++i)
    if (margins[i] < kDistinctMotion && !distinct(i - 1) && !distinct(i + 1)) frames.push_back(i);
  return frames;
}

Tracks select_tracks(std::span<const TrackObservation> observations, int start, int frames) {
  Tracks tracks;
  tracks.start = start;
  std::map<std::int64_t, int> column;
  for (const TrackObservation& o : observations) {
    if (o.frame != start) continue;
    column[o.track] = static_cast<int>(tracks.ids.size());
    tracks.ids.push_back(o.track);
  }
  const bool weighted =
      !observations.empty() &&
      std::ranges::all_of(observations, [](const auto& o) { return o.sigma_px > 0; });
  if (weighted) tracks.sigma_px.assign(frames, Eigen::VectorXd::Ones(tracks.track_count()));
  tracks.raw_px.assign(frames, Eigen::Matrix2Xd::Constant(2, tracks.track_count(), kUnseen));
  for (const TrackObservation& o : observations) {
    const auto it = column.find(o.track);
    if (o.frame < start || o.frame >= start + frames || it == column.end()) continue;
    tracks.raw_px[o.frame - start].col(it->second) = o.raw_px;
    if (weighted) tracks.sigma_px[o.frame - start][it->second] = o.sigma_px;
  }
  return tracks;
}

Tracks without(Tracks tracks, std::span<const std::int64_t> ids) {
  for (int j = 0; j < tracks.track_count(); ++j) {
    if (std::ranges::find(ids, tracks.ids[j]) == ids.end()) continue;
    for (Eigen::Matrix2Xd& raw_px : tracks.raw_px) raw_px.col(j).setConstant(kUnseen);
  }
  return tracks;
}

}  // namespace gpo
