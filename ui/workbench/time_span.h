// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/settings/settings.h"

namespace gpo {

/// Frames that the time line shows, of those of the recording.
struct TimeSpan {
  int first = 0;
  int count = 0;  ///< 0: all

  bool operator==(const TimeSpan&) const = default;
};

/// The window and as much again on both sides; everything where that is nearly all.
TimeSpan around_window(const Settings& settings, int frames);

/// A recording so long that its window would be a hairline is first shown around its window.
TimeSpan first_time_span(const Settings& settings, int frames);

/// Shows `factor` times as many frames; what is at `share` of the time line (0 to 1) stays there.
TimeSpan zoomed(const TimeSpan& span, int frames, double share, double factor);

/// Moved as little as needed to hold a frame.
TimeSpan holding(TimeSpan span, int frame);

/// The nearest settings whose window fits into so many frames (at least two).
Settings fit_window(Settings settings, int frame_count);

/// The window from `frame` on to its old end, or of its old length where it would end before.
Settings start_window_at(Settings settings, int frame, int frame_count);

/// The window from its old start up to `frame`, or of its old length where it would start after.
Settings end_window_at(Settings settings, int frame, int frame_count);

}  // namespace gpo
