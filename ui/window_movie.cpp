// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/window/timestamps.h"
#include "ui/workbench_window.h"

#include <algorithm>

namespace gpo {
namespace {

double movie_rate_hz(const MovieRequest& request, const Recording& recording) {
  constexpr double kUnknown_hz = 30;
  if (request.rate_hz > 0) return request.rate_hz;
  const double recorded = rate_hz(recording.timestamps_ns);
  return recorded > 0 ? recorded : kUnknown_hz;
}

cv::Size movie_size(const WorkbenchState& state) {
  const Recording& recording = *state.document.recording;
  if (!state.view.panes.compare) return even_size(shown_size(recording));
  return even_size(
      default_compare_size(static_cast<int>(compared_results(state).size()), recording));
}

}  // namespace

Movie::Movie(const MovieRequest& request, const WorkbenchState& state)
    : state_(state),
      view_(state.view.panes.compare ? "compare" : "picture"),
      size_(movie_size(state)),
      first_(state.document.settings.start),
      frames_(std::min(state.document.settings.frames,
                       state.frame_count() - state.document.settings.start)),
      video_(request.file, movie_rate_hz(request, *state.document.recording), size_) {}

void Movie::step(const Draw& draw) {
  if (finished()) return;
  state_.view.frame = first_ + done_;
  video_.add(draw(state_, view_, size_));
  ++done_;
  if (finished()) video_.finish();
}

}  // namespace gpo
