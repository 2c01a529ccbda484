// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/panels/panels.h"
#include "ui/views/charts/chart_view.h"

#include <cstdint>
#include <optional>
#include <string>

namespace gpo {

/// A chart that was drawn, and the mouse over it.
struct ChartItem {
  ChartMapping to;                     ///< values to screen pixels
  std::optional<double> hovered = {};  ///< value of the x axis under the mouse
  bool held = false;                   ///< the left button was pressed there and is down
};

/// Draws a chart with a cursor and a tooltip under the mouse; a right click copies its data.
/// `name`: of its cache in the views, and of the item.
ChartItem chart_item(const std::string& name,
                     const Rectangle& place,
                     Views& views,
                     const Chart& chart,
                     bool legend = true);

/// Draws a cursor at the current frame that the mouse can drag. `zero`: the frame (counts in the
/// recording) at x = 0; a frame has width 1.
void drag_frame(const ChartItem& item, const PanelContext& ui, int zero, Role role);

}  // namespace gpo
