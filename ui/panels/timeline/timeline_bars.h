// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/panels/timeline/time_axis.h"
#include "ui/workbench/state.h"

#include <span>

struct ImDrawList;

namespace gpo {

/// Bars: how many tracks live in each frame of the window, inliers below, the rest above. The
/// inliers' color is the verdict of the window that ends at the frame. Between `top` and `bottom`
/// [screen px].
void draw_tracks(
    ImDrawList& list, const Inspection& inspection, const TimeAxis& axis, float top, float bottom);

/// Where the verdict changes, its sign stands in the bars at height `y` [screen px]: for people who
/// see few colors.
void draw_verdict_signs(
    ImDrawList& list, const Inspection& inspection, const TimeAxis& axis, float y, float scale);

/// One line that says what the bars mean.
void draw_verdict_legend(
    ImDrawList& list, const Inspection& inspection, float left, float top, float scale);

/// Thin lines over the bars: parallax, and the rate of rotation, each to its own largest value.
void draw_motion(
    ImDrawList& list, const Inspection& inspection, const TimeAxis& axis, float top, float bottom);

/// A line where the window has become long enough to tell meters; nothing where it never does.
void draw_scale_mark(ImDrawList& list,
                     const Inspection& inspection,
                     const TimeAxis& axis,
                     float top,
                     float bottom,
                     float scale);

/// Small flags at the upper edge.
void draw_bookmarks(ImDrawList& list,
                    std::span<const Bookmark> bookmarks,
                    const TimeAxis& axis,
                    float top,
                    float scale);

}  // namespace gpo
