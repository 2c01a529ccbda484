// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/settings/settings_table.h"

namespace gpo {

/// Frames of the recording that the time line shows.
struct TimeSpan {
  int first = 0;
  int count = 0;  ///< 0: all

  bool operator==(const TimeSpan&) const = default;
};

/// The window and its length again on both sides; all frames if that is nearly all.
TimeSpan around_window(const Settings& settings, int frames);

/// The initial span: all frames, or the surroundings of the window if the recording is so long that
/// its window would be a hairline.
TimeSpan first_time_span(const Settings& settings, int frames);

/// Shows `factor` times as many frames and keeps the frame at `share` of the time line (0 to 1).
TimeSpan zoomed(const TimeSpan& span, int frames, double share, double factor);

/// Moves the span as little as needed to include a frame.
TimeSpan holding(TimeSpan span, int frame);

/// The nearest settings whose window fits into the recording and has at least two frames.
Settings fit_window(Settings settings, int frame_count);

/// Starts the window at `frame` and keeps its end, or its length if it would end before its start.
Settings start_window_at(Settings settings, int frame, int frame_count);

/// Ends the window at `frame` and keeps its start, or its length if it would start after its end.
Settings end_window_at(Settings settings, int frame, int frame_count);

}  // namespace gpo
