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

/// Returns whether the mouse draws a mask in the frame, the reference frame.
bool takes_mask(const WorkbenchState& state, int frame);
/// Adds a corner where the last item is clicked, or finishes the mask: after a drag a rectangle,
/// after a click at the first corner a polygon.
void draw_mask_by_mouse(const PanelContext& ui, const ImageMapping& mapping);
/// Draws the mask as far as it is drawn, and what to do.
void draw_unfinished_mask(const PanelContext& ui, const Area& area, const ImageMapping& mapping);

}  // namespace gpo
