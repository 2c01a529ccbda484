// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/views/image_view.h"
#include "ui/views/scene_view.h"
#include "ui/views/track_highlight.h"
#include "ui/workbench/layout.h"
#include "ui/workbench/workbench.h"

#include <memory>

namespace gpo {

/// What the state asks the views to show. `inspection` may be null.
ImageViewOptions image_options(const WorkbenchState& state, const Inspection* inspection);
SceneViewOptions scene_options(const WorkbenchState& state);

/// What is picked and pointed at, by columns of the inspection's tracks. Nothing without one.
Highlight highlight_of(const WorkbenchState& state);

/// Whether a legend leaves enough of the view to be seen.
bool room_for_legend(const Rectangle& place, float scale);

ScreenRect screen_rect(const Rectangle& place);

/// For the views, while nothing has been computed: a recording with an empty window.
Inspection nothing_inspected(std::shared_ptr<const Recording> recording);

}  // namespace gpo
