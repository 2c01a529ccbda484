// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"

namespace gpo {

/// Takes other settings; the old ones can be had back by `undo`. Those that follow each other while
/// `dragging` are undone together.
void change_settings(WorkbenchState& state, Settings settings, bool dragging = false);

/// The settings before the last change, and again those after it; as they are where there are none.
void undo(WorkbenchState& state);
void redo(WorkbenchState& state);

}  // namespace gpo
