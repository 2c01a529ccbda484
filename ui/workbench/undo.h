// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"

namespace gpo {

/// Takes other settings; the old ones can be had back by `undo`. Those that follow each other while
/// `dragging` are undone together.
void change_settings(WorkbenchState& state, Settings settings, bool dragging = false);

/// Puts the cube where that ray of the reference camera meets the plane; nothing: back to its
/// place.
void move_cube(WorkbenchState& state, const std::optional<Eigen::Vector3d>& ray);

/// As it was before the last change, and again as after it; as it is where there is none.
void undo(WorkbenchState& state);
void redo(WorkbenchState& state);

}  // namespace gpo
