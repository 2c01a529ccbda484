// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/panels/panels.h"

namespace gpo {

/// Lets the mouse drag a cube in the image, the last item, along the cube's plane. `frame` counts
/// in the recording. Returns whether the mouse pressed a cube, which must not pan the image then.
bool drag_cube(const PanelContext& ui, int frame, const ImageMapping& mapping);

}  // namespace gpo
