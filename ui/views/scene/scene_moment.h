// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/views/scene/scene_view.h"

namespace gpo {

/// What of the scene belongs to one frame only: its camera, its true camera and its uncertainty,
/// drawn over the rendered rest, so that a step does not render the scene anew. `frame_in_window`
/// may be outside of the window.
void draw_scene_moment(ImDrawList& list,
                       const ScreenRect& rect,
                       const Inspection& inspection,
                       int frame_in_window,
                       const OrbitCamera& camera,
                       const ViewOptions& options);

}  // namespace gpo
