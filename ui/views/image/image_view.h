// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/look/zoom.h"
#include "ui/views/overlay/view_options.h"

#include <memory>

struct ImDrawList;

namespace gpo {

class ImageTexture;

/// Draws frame `frame` (counts in the recording) into the rectangle: the picture as it was
/// recorded, tracks, cube, legend, and the reason where the initialization failed. `image` is
/// null, or empty, where the recording has no pictures.
void draw_image_view(ImDrawList& list,
                     const ScreenRect& rect,
                     const Inspection& inspection,
                     int frame,
                     ImageTexture* image,
                     const ImageZoom& zoom,
                     const ViewOptions& options);

/// Side of the virtual cube: as chosen, or the default where `chosen` is 0 [unit of the estimate].
double cube_side(const Inspection& inspection, double chosen);

/// For the views, while nothing has been computed: a recording with an empty window.
Inspection nothing_to_show(std::shared_ptr<const Recording> recording);

}  // namespace gpo
