// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/undo.h"

#include "ui/workbench/time_span.h"

#include <utility>

namespace gpo {
namespace {

UndoStep now(const WorkbenchState& state) {
  return {state.settings, state.cube_side, state.cube_ray};
}

void remember(WorkbenchState& state) {
  constexpr std::size_t kMostUndo = 200;
  state.undo.push_back(now(state));
  if (state.undo.size() > kMostUndo) state.undo.erase(state.undo.begin());
  state.redo.clear();
}

/// `from` becomes how things are, and these become the last of `to`.
void step_back(WorkbenchState& state, std::vector<UndoStep>& from, std::vector<UndoStep>& to) {
  if (from.empty()) return;
  to.push_back(now(state));
  state.settings = from.back().settings;
  state.cube_side = from.back().cube_side;
  state.cube_ray = from.back().cube_ray;
  from.pop_back();
  state.dragging_settings = false;
}

}  // namespace

void change_settings(WorkbenchState& state, Settings settings, bool dragging) {
  if (state.recording) settings = fit_window(settings, state.frame_count());
  // Their ids count within the tracks of one reference frame.
  if (settings.start != state.settings.start) settings.exclude.clear();
  if (settings == state.settings) return;
  if (!dragging || !state.dragging_settings) remember(state);
  state.dragging_settings = dragging;
  state.redo.clear();
  state.settings = std::move(settings);
}

void move_cube(WorkbenchState& state, const std::optional<Eigen::Vector3d>& ray) {
  if (ray == state.cube_ray) return;
  remember(state);
  state.dragging_settings = false;
  state.cube_ray = ray;
}

void undo(WorkbenchState& state) { step_back(state, state.undo, state.redo); }
void redo(WorkbenchState& state) { step_back(state, state.redo, state.undo); }

}  // namespace gpo
