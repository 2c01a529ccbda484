// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/panels/panels.h"
#include "ui/workbench/commands.h"
#include "ui/workbench/state.h"

#include <cstdint>

namespace gpo {

/// What is known of a track in the current frame, beside the mouse.
void track_tooltip(const PanelInput& input, Views& views, std::int64_t track);

/// The camera of a frame (counts in the recording).
void camera_tooltip(const PanelInput& input, int frame);

/// The plane of the track of this id leads from now on, where another one does.
void lead_with(const WorkbenchState& state, std::int64_t id, Commands& commands);

}  // namespace gpo
