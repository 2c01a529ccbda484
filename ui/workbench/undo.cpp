// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/undo.h"

#include "ui/workbench/time_span.h"

#include <utility>

namespace gpo {
namespace {

UndoStep now(const WorkbenchState& state) {
  return {state.document.settings, state.document.cube_side, state.document.cube_ray};
}

void remember(WorkbenchState& state) {
  constexpr std::size_t kMostUndo = 200;
  state.document.undo.push_back(now(state));
  if (state.document.undo.size() > kMostUndo)
    state.document.undo.erase(state.document.undo.begin());
  state.document.redo.clear();
}

/// `from` becomes how things are, and these become the last of `to`.
void step_back(WorkbenchState& state, std::vector<UndoStep>& from, std::vector<UndoStep>& to) {
  if (from.empty()) return;
  to.push_back(now(state));
  state.document.settings = from.back().settings;
  state.document.cube_side = from.back().cube_side;
  state.document.cube_ray = from.back().cube_ray;
  from.pop_back();
  state.document.dragging_settings = false;
}

}  // namespace

void change_settings(WorkbenchState& state, Settings settings, bool dragging) {
  if (state.document.recording) settings = fit_window(settings, state.frame_count());
  // Their ids count within the tracks of one reference frame.
  if (settings.start != state.document.settings.start) settings.exclude.clear();
  if (settings == state.document.settings) return;
  if (!dragging || !state.document.dragging_settings) remember(state);
  state.document.dragging_settings = dragging;
  state.document.redo.clear();
  state.document.settings = std::move(settings);
}

void move_cube(WorkbenchState& state, const std::optional<Eigen::Vector3d>& ray) {
  if (ray == state.document.cube_ray) return;
  remember(state);
  state.document.dragging_settings = false;
  state.document.cube_ray = ray;
}

void undo(WorkbenchState& state) { step_back(state, state.document.undo, state.document.redo); }
void redo(WorkbenchState& state) { step_back(state, state.document.redo, state.document.undo); }

}  // namespace gpo
