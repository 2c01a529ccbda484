// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/adopt.h"

#include "ui/workbench/session/session_file.h"
#include "ui/workbench/time_span.h"

#include <algorithm>
#include <utility>

namespace gpo {

namespace {

/// Another recording does not get the window and the method that were chosen for this one.
void change_span(WorkbenchState& state, const Recording& to) {
  const Settings& now = state.settings;
  const auto& from = state.recording->path;
  std::erase_if(state.spans, [&](const KeptSpan& one) { return one.recording == from; });
  state.spans.push_back({from, now.start, now.frames, now.options.method});
  const auto kept = std::ranges::find(state.spans, to.path, &KeptSpan::recording);
  const Settings standard;
  const KeptSpan span =
      kept == state.spans.end()
          ? KeptSpan{to.path, standard.start, standard.frames, standard.options.method}
          : *kept;
  state.settings.start = span.start;
  state.settings.frames = span.frames;
  state.settings.options.method = span.method;
}

}  // namespace

void adopt(WorkbenchState& state, std::shared_ptr<const Recording> recording) {
  // The same pictures with another camera: what was found in them is still there.
  const bool same =
      state.recording && recording->pictures && state.recording->pictures == recording->pictures;
  const int frame = state.frame;
  // What is opened first gets what the command line says.
  if (state.recording && !same) change_span(state, *recording);
  state.recording = std::move(recording);
  state.inspection.reset();
  state.surveyed = std::make_shared<const SurveyResults>();
  state.study.reset();
  state.scan.reset();
  state.selection = {};
  state.hover = {};
  state.cube_ray.reset();
  if (!same) state.bookmarks.clear();
  state.settings.exclude.clear();
  state.undo.clear();
  state.redo.clear();
  state.playing = false;
  state.play_seconds = 0;
  state.picture_zoom = {};
  state.compare_zoom.reset();
  state.normals_zoom = {};
  state.orbit.reset();
  const Settings fitting = fit_window(state.settings, state.frame_count());
  state.message.clear();
  for (const std::string& note : state.recording->notes) say(state, note);
  if (!state.recording->notes.empty()) {
    state.message = state.recording->notes.front();
    state.message_severity = Severity::note;
    state.message_seconds = 0;
  }
  if (fitting.start != state.settings.start) {
    say(state,
        "start " + std::to_string(state.settings.start) + " does not fit: the last of " +
            std::to_string(state.frame_count()) + " frames is " +
            std::to_string(state.frame_count() - 1),
        Severity::warning);
  }
  state.settings = fitting;
  state.time_span = first_time_span(fitting, state.frame_count());
  state.frame = std::max(0, fitting.start + std::min(fitting.frames, state.frame_count()) - 1);
  if (same) state.frame = frame;
  if (const auto session = std::exchange(state.waiting_session, {}))
    continue_session(state, *session);
}

}  // namespace gpo
