// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/window/window_tracks.h"

#include "engine/base/error.h"
#include "engine/frontend/tracking/tracker.h"
#include "engine/inspection/window/cached.h"
#include "engine/recording/frame_cache.h"

#include <chrono>
#include <utility>

#include <fmt/format.h>

namespace gpo {

Tracked chosen_tracks(const Recording& recording, int start, int frames) {
  const auto begin = std::chrono::steady_clock::now();
  Tracks tracks = select_tracks(recording.tracks, start, frames);
  return {std::make_shared<const Tracks>(std::move(tracks)),
          std::vector<double>(frames, milliseconds_since(begin))};
}

std::optional<Tracked> followed_tracks(const Recording& recording,
                                       int start,
                                       int frames,
                                       Tracking tracking,
                                       const std::stop_token& stop,
                                       const Progress& progress) {
  if (!recording.images) {
    throw InputError(
        fmt::format("{}: no pictures and no tracks; expected a file of tracks", recording.name));
  }
  Tracked tracked;
  const auto begin = std::chrono::steady_clock::now();
  const auto told = [&](int done, int of) {
    tracked.milliseconds.push_back(milliseconds_since(begin));
    if (progress) progress("tracking", done, of);
  };
  const TrackerOptions options{.tracking = tracking};
  ImagesAhead images(*recording.images, start, start + frames);
  auto tracks = track_window([&](int frame) { return images.gray(frame); },
                             recording.camera,
                             {start, frames},
                             options,
                             {stop, told});
  if (!tracks) return std::nullopt;
  tracked.tracks = std::make_shared<const Tracks>(std::move(*tracks));
  return tracked;
}

std::shared_ptr<const Tracks> beginning(const std::shared_ptr<const Tracks>& whole, int frames) {
  if (whole->frame_count() == frames) return whole;
  Tracks tracks = *whole;
  tracks.raw_px.resize(frames);
  if (!tracks.forward_backward_px.empty()) tracks.forward_backward_px.resize(frames);
  for (std::optional<TrackEnd>& end : tracks.ends) {
    if (end && end->frame >= frames) end.reset();
  }
  return std::make_shared<const Tracks>(std::move(tracks));
}

}  // namespace gpo
