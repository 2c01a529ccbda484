// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/time_span.h"

#include <algorithm>
#include <cmath>

namespace gpo {

namespace {

constexpr int kFewest = 10;  // frames of the time line
constexpr int kLeastWindow = 2, kLongestWindow = 1000;

TimeSpan within(double first, int count, int frames) {
  if (count >= frames) return {};
  const auto least = static_cast<int>(std::lround(first));
  return {std::clamp(least, 0, frames - count), count};
}

}  // namespace

TimeSpan around_window(const Settings& settings, int frames) {
  const int count = std::max(3 * settings.frames, 2 * kFewest);
  const int margin = (count - settings.frames) / 2;
  return within(settings.start - margin, count, frames);
}

TimeSpan first_time_span(const Settings& settings, int frames) {
  constexpr int kHairline = 50;  // recording's length in windows
  if (frames < kHairline * settings.frames) return {};
  return zoomed(around_window(settings, frames), frames, 0.5, 4);
}

TimeSpan zoomed(const TimeSpan& span, int frames, double share, double factor) {
  const int shown = span.count > 0 ? span.count : frames;
  const int count =
      std::clamp(static_cast<int>(std::lround(shown * factor)), std::min(kFewest, frames), frames);
  return within(span.first + share * (shown - count), count, frames);
}

TimeSpan holding(TimeSpan span, int frame) {
  if (span.count > 0) span.first = std::clamp(span.first, frame - span.count + 1, frame);
  return span;
}

Settings fit_window(Settings settings, int frame_count) {
  const int longest = std::clamp(frame_count, kLeastWindow, kLongestWindow);
  settings.frames = std::clamp(settings.frames, kLeastWindow, longest);
  settings.start = std::clamp(settings.start, 0, std::max(0, frame_count - settings.frames));
  return settings;
}

Settings start_window_at(Settings settings, int frame, int frame_count) {
  const int end = settings.start + settings.frames;
  settings.start = std::clamp(frame, 0, std::max(0, frame_count - kLeastWindow));
  settings.frames = settings.start <= end - kLeastWindow
                        ? end - settings.start
                        : std::min(settings.frames, frame_count - settings.start);
  return fit_window(settings, frame_count);
}

Settings end_window_at(Settings settings, int frame, int frame_count) {
  const int end = std::clamp(frame + 1, kLeastWindow, std::max(kLeastWindow, frame_count));
  if (end < settings.start + kLeastWindow) settings.start = std::max(0, end - settings.frames);
  settings.start = std::max(settings.start, end - kLongestWindow);
  settings.frames = end - settings.start;
  return fit_window(settings, frame_count);
}

}  // namespace gpo
