// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/tracking/tracking.h"
#include "engine/inspection/window/progress.h"
#include "engine/recording/recording.h"
#include "engine/window/tracks.h"

#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

namespace gpo {

/// Tracks are made frame by frame, so that those of a shorter window are the beginning of these.
struct Tracked {
  std::shared_ptr<const Tracks> tracks;
  std::vector<double> milliseconds;  ///< one a frame: when it was done
};

/// Other people's tracks, of a recording that has them.
Tracked chosen_tracks(const Recording& recording, int start, int frames);

/// The built-in front end's; nothing where stopped. Throws InputError of a recording without
/// pictures.
std::optional<Tracked> followed_tracks(const Recording& recording,
                                       int start,
                                       int frames,
                                       Tracking tracking,
                                       const std::stop_token& stop,
                                       const Progress& progress);

/// The first frames of a longer window's.
std::shared_ptr<const Tracks> beginning(const std::shared_ptr<const Tracks>& whole, int frames);

}  // namespace gpo
