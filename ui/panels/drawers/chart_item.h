// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/panels/panels.h"
#include "ui/views/charts/chart_view.h"

#include <optional>
#include <string>

namespace gpo {

/// A chart that was drawn, and what the mouse does over it.
struct ChartItem {
  ChartMapping to;                     ///< values to screen pixels
  std::optional<double> hovered = {};  ///< the mouse rests there [value of the x axis]
  bool held = false;                   ///< ... with its left button down since it was pressed there
};

/// A chart as a part of a panel. Over its axes the mouse draws a line and tells the values.
/// `name`: of its picture in `views`, and of the item.
ChartItem chart_item(const std::string& name,
                     const Rectangle& place,
                     Views& views,
                     const Chart& chart,
                     bool legend = true);

}  // namespace gpo
