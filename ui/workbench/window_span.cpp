// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/window_span.h"

#include <algorithm>

namespace gpo {
namespace {

constexpr int kLeastWindow = 2;
constexpr int kLongestWindow = 1000;

}  // namespace

Settings fit_window(Settings settings, int frame_count) {
  const int longest = std::clamp(frame_count, kLeastWindow, kLongestWindow);
  settings.frames = std::clamp(settings.frames, kLeastWindow, longest);
  settings.start = std::clamp(settings.start, 0, std::max(0, frame_count - settings.frames));
  return settings;
}

Settings start_window_at(Settings settings, int frame, int frame_count) {
  const int end = settings.start + settings.frames;
  settings.start = std::clamp(frame, 0, std::max(0, frame_count - kLeastWindow));
  if (settings.start <= end - kLeastWindow) {
    settings.frames = end - settings.start;
  } else {
    settings.frames = std::min(settings.frames, frame_count - settings.start);
  }
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
