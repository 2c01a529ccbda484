// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "ui/look/rect.h"
#include "ui/views/charts/chart_mapping.h"

#include <cstdint>
#include <memory>
#include <string>

struct ImDrawList;

namespace gpo {

/// A chart of the window, by VTK. Needs the context in which it was made to be current.
class ChartView {
 public:
  ChartView();
  ~ChartView();
  ChartView(const ChartView&) = delete;
  ChartView& operator=(const ChartView&) = delete;

  /// The texture of axes, ticks, grid, bands and curves in their own colors, bottom row first; 0
  /// for an empty size. No titles. Renders only when something has changed since the last call.
  /// `scale`: of lines and text [px of 96 dpi]; `top_px`: left free above the axes.
  unsigned render(const Chart& chart, int width, int height, double scale, double top_px);

  /// Where the values are in that picture: y down, from its upper left corner [px].
  const ChartMapping& mapping() const;
  /// Counts the renderings: another one, another picture.
  std::size_t revision() const;

 private:
  struct Pipeline;
  std::unique_ptr<Pipeline> pipeline_;
};

/// Draws the chart with its titles and, where curves have different names, a legend. Returns
/// where the values are [screen px], to draw over it.
ChartMapping draw_chart_view(ImDrawList& list,
                             const ScreenRect& rect,
                             ChartView& view,
                             const Chart& chart,
                             bool legend = true);

/// A line across the chart at `x`, where that is within its axis.
void draw_chart_cursor(ImDrawList& list, const ChartMapping& to, double x, std::uint32_t rgb);

/// What the curves say nearest to `x`, one line each, below the value of the x axis; empty where
/// there is nothing.
std::string chart_values_at(const Chart& chart, double x);

}  // namespace gpo
