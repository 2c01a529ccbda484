// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/panels/panels.h"
#include "ui/views/charts/chart_view.h"

#include <cstdint>
#include <optional>
#include <string>

namespace gpo {

/// A chart that was drawn, and what the mouse does over it.
struct ChartItem {
  ChartMapping to;                     ///< values to screen pixels
  std::optional<double> hovered = {};  ///< the mouse rests there [value of the x axis]
  bool held = false;                   ///< ... with its left button down since it was pressed there
};

/// A chart as a part of a panel. Over its axes the mouse draws a line and tells the values; a right
/// click copies all of them. `name`: of its picture in `views`, and of the item.
ChartItem chart_item(const std::string& name,
                     const Rectangle& place,
                     Views& views,
                     const Chart& chart,
                     bool legend = true);

/// A line at the current frame that the mouse drags to another one. `zero`: the frame (counts in
/// the recording) at 0 of the x axis, of which each frame takes 1.
void drag_frame(const ChartItem& item,
                const WorkbenchState& state,
                int zero,
                std::uint32_t rgb,
                Commands& commands);

}  // namespace gpo
