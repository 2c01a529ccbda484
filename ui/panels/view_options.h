// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/panels/panels.h"
#include "ui/views/compare/compare_view.h"
#include "ui/views/image/image_view.h"
#include "ui/views/image/pointing.h"
#include "ui/views/scene/scene_view.h"
#include "ui/workbench/compared.h"

#include <cstdint>
#include <vector>

namespace gpo {

/// Returns the options for the views. Updates the cached colors and model.
ViewOptions view_options(const WorkbenchState& state, Views& views);

std::vector<CompareColumn> compare_columns(const std::vector<Compared>& results);

/// Returns the state with another result in place of the current one; with none until it is
/// computed.
WorkbenchState showing(const WorkbenchState& state, const Compared& other);
/// Names the result that the image shows in place of the current one, in its upper right corner.
void draw_flip_label(ImDrawList& list, const ScreenRect& rect, const Compared& other);

/// Returns the selected and the hovered tracks as columns of the inspection's tracks.
Highlight highlight_of(const WorkbenchState& state);

/// Returns whether a view is large enough for a legend.
bool has_room_for_legend(const Rectangle& place, float scale);

ScreenRect screen_rect(const Rectangle& place);

/// Shows a track's position, errors and verdict in the current frame beside the mouse.
void track_tooltip(const PanelContext& ui, std::int64_t track);

/// Selects a track; with Ctrl adds or removes it. A click without Ctrl also makes its plane the
/// leading one.
void click_track(const PanelContext& ui, std::int64_t id);

}  // namespace gpo
