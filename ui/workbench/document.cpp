// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Changes of the document that can be undone.
#include "engine/base/error.h"
#include "ui/workbench/state.h"

#include <utility>

namespace gpo {
namespace {

void push_undo(Document& document) {
  constexpr std::size_t kMostUndo = 200;
  document.undo.push_back(document);
  if (document.undo.size() > kMostUndo) document.undo.erase(document.undo.begin());
  document.redo.clear();
}

/// Restores the last step of `from` and appends the current one to `to`. A note on the change that
/// is undone would be wrong now, so it vanishes.
void step_back(WorkbenchState& state, std::vector<UndoStep>& from, std::vector<UndoStep>& to) {
  if (from.empty()) return;
  Document& document = state.document;
  if (state.messages.severity == Severity::note) state.messages.text.clear();
  to.push_back(document);
  static_cast<UndoStep&>(document) = from.back();
  from.pop_back();
  document.dragging_settings = false;
}

/// Removes what belongs to the reference frame `before.start` from settings with another one: the
/// ids of excluded tracks, and the areas of masks, whose content is elsewhere in another image.
void leave_reference_frame(WorkbenchState& state, Settings& settings, const Settings& before) {
  const auto masks = before.mask.areas.size();
  if (masks > 0 && state.document.settings.mask == before.mask)
    say(state,
        counted(masks, "mask") + " of frame " + std::to_string(before.start) +
            " removed: the window starts elsewhere. Ctrl+Z restores both");
  settings.exclude.clear();
  settings.mask = {};
}

}  // namespace

void change_settings(WorkbenchState& state, Settings settings, bool dragging) {
  Document& document = state.document;
  if (document.recording) settings = fit_window(settings, state.frame_count());
  const bool continues = dragging && document.dragging_settings && !document.undo.empty();
  const Settings& before = continues ? document.undo.back().settings : document.settings;
  if (settings.start != before.start) {
    leave_reference_frame(state, settings, before);
  } else if (continues) {
    settings.exclude = before.exclude;
    settings.mask = before.mask;
  }
  if (settings == document.settings) return;
  if (!continues) push_undo(document);
  document.dragging_settings = dragging;
  document.redo.clear();
  document.settings = std::move(settings);
}

void move_cube(WorkbenchState& state,
               const std::optional<Vector3d>& ray,
               int plane,
               bool dragging) {
  Document& document = state.document;
  UndoStep moved = document;
  if (ray && plane > 0)
    moved.other_cube_rays[plane] = *ray;
  else
    moved.cube_ray = ray;
  if (!ray) moved.other_cube_rays.clear();
  if (moved.cube_ray == document.cube_ray && moved.other_cube_rays == document.other_cube_rays)
    return;
  if (!dragging) push_undo(document);
  document.redo.clear();
  document.dragging_settings = false;
  static_cast<UndoStep&>(document) = std::move(moved);
}

void undo(WorkbenchState& state) { step_back(state, state.document.undo, state.document.redo); }

void redo(WorkbenchState& state) { step_back(state, state.document.redo, state.document.undo); }

}  // namespace gpo
