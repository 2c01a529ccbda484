// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/views/compare/compare_view.h"
#include "ui/views/image/image_view.h"
#include "ui/views/image/track_highlight.h"
#include "ui/views/scene/scene_view.h"
#include "ui/workbench/compared.h"
#include "ui/workbench/layout.h"
#include "ui/workbench/state.h"

#include <vector>

namespace gpo {

struct Views;

/// What the state asks the views to show. Colors and model are made where those kept are others.
ViewOptions view_options(const WorkbenchState& state, Views& views);

std::vector<CompareColumn> compare_columns(const std::vector<Compared>& results);

/// The state with another's result in place of the current one. While it is computed there is none.
WorkbenchState showing(const WorkbenchState& state, const Compared& other);
/// In the upper right corner of the picture: whose result is seen in place of the current one.
void draw_flip_label(ImDrawList& list, const ScreenRect& rect, const Compared& other);

/// What is picked and pointed at, by columns of the inspection's tracks. Nothing without one.
Highlight highlight_of(const WorkbenchState& state);

/// Whether a legend leaves enough of the view to be seen.
bool room_for_legend(const Rectangle& place, float scale);

ScreenRect screen_rect(const Rectangle& place);
}  // namespace gpo
