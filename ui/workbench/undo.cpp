// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/undo.h"

#include "ui/workbench/window_span.h"

#include <utility>

namespace gpo {
namespace {

/// `from` becomes the settings, and these become the last of `to`.
void step_back(WorkbenchState& state, std::vector<Settings>& from, std::vector<Settings>& to) {
  if (from.empty()) return;
  to.push_back(std::exchange(state.settings, from.back()));
  from.pop_back();
  state.dragging_settings = false;
}

}  // namespace

void change_settings(WorkbenchState& state, Settings settings, bool dragging) {
  constexpr std::size_t kMostUndo = 200;
  if (state.recording) settings = fit_window(settings, state.frame_count());
  // Their ids count within the tracks of one reference frame.
  if (settings.start != state.settings.start) settings.exclude.clear();
  if (settings == state.settings) return;
  if (!dragging || !state.dragging_settings) state.undo.push_back(state.settings);
  if (state.undo.size() > kMostUndo) state.undo.erase(state.undo.begin());
  state.dragging_settings = dragging;
  state.redo.clear();
  state.settings = std::move(settings);
}

void undo(WorkbenchState& state) { step_back(state, state.undo, state.redo); }
void redo(WorkbenchState& state) { step_back(state, state.redo, state.undo); }

}  // namespace gpo
