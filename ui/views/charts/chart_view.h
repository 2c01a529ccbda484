// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "ui/look/palette.h"
#include "ui/look/zoom.h"
#include "ui/views/charts/chart_mapping.h"
#include "ui/views/image/image_texture.h"

#include <cstdint>
#include <string>

#include <opencv2/core.hpp>

struct ImDrawList;

namespace gpo {

/// How a chart of the window is to be drawn.
struct ChartRequest {
  Chart chart;
  cv::Size size;     ///< [px]
  double scale = 1;  ///< of lines and text [px of 96 dpi]
  bool legend = true;
  Theme theme = Theme::dark;
};

struct ChartImage {
  cv::Mat bgr;
  ChartMapping mapping;  ///< [px from the upper left corner, y down]
};

/// Draws axes with their ticks, grid, bands and curves, titles, and a legend where curves have
/// different names.
ChartImage draw_window_chart(const ChartRequest& request);

/// A chart of the window in the graphics memory. Needs the context in which it was made to be
/// current.
class ChartView {
 public:
  /// Draws if something has changed since the last call. The size is not empty.
  void update(const ChartRequest& request);

  const ImageTexture& texture() const { return texture_; }
  const ChartMapping& mapping() const { return mapping_; }

 private:
  ChartRequest shown_;
  ChartMapping mapping_;
  ImageTexture texture_;
};

/// Draws the chart into the window in the current theme. Returns the places of values [screen px],
/// to draw over it.
ChartMapping draw_chart_view(ImDrawList& list,
                             const ScreenRect& rect,
                             ChartView& view,
                             const Chart& chart,
                             bool legend = true);

/// Draws a line across the chart at `x`, if that is within its axis.
void draw_chart_cursor(ImDrawList& list, const ChartMapping& to, double x, std::uint32_t rgb);

/// Returns the curves' values nearest to `x`, one a line, below the value of the x axis; empty if
/// there are none.
std::string chart_values_at(const Chart& chart, double x);

}  // namespace gpo
