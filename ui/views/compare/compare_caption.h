// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/zoom.h"
#include "ui/views/compare/compare_column.h"

struct ImDrawList;

namespace gpo {

/// Title in the configuration's color, verdict, and under which conditions it was computed.
void draw_compare_heading(ImDrawList& list, const ScreenRect& rect, const CompareColumn& column);

/// What the result is worth. `first`: of the first column, to which the others are compared; null:
/// this is it.
void draw_compare_caption(ImDrawList& list,
                          const ScreenRect& rect,
                          const Inspection& inspection,
                          const Inspection* first);

}  // namespace gpo
