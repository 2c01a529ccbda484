// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/look/zoom.h"
#include "ui/views/overlay/view_options.h"

struct ImDrawList;

namespace gpo {

class ImageTexture;

/// Draws a frame into the rectangle: the image, tracks, cube, legend, and the reason if the
/// initialization failed. `image` is null or empty if the recording has no images.
void draw_image_view(ImDrawList& list,
                     const ScreenRect& rect,
                     const FrameView& view,
                     ImageTexture* image,
                     const ImageZoom& zoom);

/// Returns the side of the virtual cube [unit of the estimate]: `chosen`, or the default if it is
/// 0.
double cube_side(const Inspection& inspection, double chosen);

/// Returns an inspection with an empty window, for the views until a window has been computed.
Inspection nothing_to_show(std::shared_ptr<const Recording> recording);

}  // namespace gpo
