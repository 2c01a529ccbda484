// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/apply_recording.h"

#include "ui/workbench/session/session_file.h"
#include "ui/workbench/time_span.h"

#include <algorithm>
#include <utility>

namespace gpo {

namespace {

/// Another recording does not get the window and the method that were chosen for this one.
void change_span(WorkbenchState& state, const Recording& to) {
  const Settings& now = state.document.settings;
  const auto& from = state.document.recording->path;
  std::erase_if(state.document.spans, [&](const SavedSpan& one) { return one.recording == from; });
  state.document.spans.push_back({from, now.start, now.frames, now.options.method});
  const auto kept = std::ranges::find(state.document.spans, to.path, &SavedSpan::recording);
  const Settings standard;
  const SavedSpan span =
      kept == state.document.spans.end()
          ? SavedSpan{to.path, standard.start, standard.frames, standard.options.method}
          : *kept;
  state.document.settings.start = span.start;
  state.document.settings.frames = span.frames;
  state.document.settings.options.method = span.method;
}

}  // namespace

void apply_recording(WorkbenchState& state, std::shared_ptr<const Recording> recording) {
  // The same pictures with another camera: what was found in them is still there.
  const bool same = state.document.recording && recording->images &&
                    state.document.recording->images == recording->images;
  const int frame = state.view.frame;
  // What is opened first gets what the command line says.
  if (state.document.recording && !same) change_span(state, *recording);
  state.document.recording = std::move(recording);
  state.results.inspection.reset();
  state.results.surveyed = std::make_shared<const SurveyResults>();
  state.results.study.reset();
  state.results.scan.reset();
  state.selection = {};
  state.hover = {};
  state.document.cube_ray.reset();
  if (!same) state.document.bookmarks.clear();
  state.document.settings.exclude.clear();
  state.document.undo.clear();
  state.document.redo.clear();
  state.view.playing = false;
  state.view.play_seconds = 0;
  state.view.image_zoom = {};
  state.view.compare_zoom.reset();
  state.view.normals_zoom = {};
  state.view.orbit.reset();
  const Settings fitting = fit_window(state.document.settings, state.frame_count());
  state.messages.text.clear();
  for (const std::string& note : state.document.recording->notes) say(state, note);
  if (!state.document.recording->notes.empty()) {
    state.messages.text = state.document.recording->notes.front();
    state.messages.severity = Severity::note;
    state.messages.seconds = 0;
  }
  if (fitting.start != state.document.settings.start) {
    say(state,
        "start " + std::to_string(state.document.settings.start) + " does not fit: the last of " +
            std::to_string(state.frame_count()) + " frames is " +
            std::to_string(state.frame_count() - 1),
        Severity::warning);
  }
  state.document.settings = fitting;
  state.view.time_span = first_time_span(fitting, state.frame_count());
  state.view.frame = std::max(0, fitting.start + std::min(fitting.frames, state.frame_count()) - 1);
  if (same) state.view.frame = frame;
  if (const auto session = std::exchange(state.files.waiting_session, {}))
    continue_session(state, *session);
}

}  // namespace gpo
