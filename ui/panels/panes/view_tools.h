// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/panels/panels.h"

namespace gpo {

/// Lets the mouse drag a cube in the image, the last item, along the cube's plane. `frame` counts
/// in the recording. Returns whether the mouse pressed a cube, which must not pan the image then.
bool drag_cube(const PanelContext& ui, int frame, const ImageMapping& mapping);

/// Lets the mouse orbit, move and zoom the scene, the last item, or drag a cube along its plane.
void orbit_and_zoom(const PanelContext& ui, const ScreenRect& rect, const OrbitCamera& camera);

/// Draws the picked points and those that set the scale, in the frame that shows them.
void draw_picked_points(const WorkbenchState& state,
                        const Area& area,
                        const FrameView& view,
                        const ImageMapping& mapping);

}  // namespace gpo
