// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/studies/track_life.h"
#include "ui/context/opengl.h"
#include "ui/views/charts/chart_drawing.h"
#include "ui/views/overlay/overlay.h"

namespace gpo {

struct ChartRequest {
  Chart chart;
  cv::Size size;     ///< [px]
  double scale = 1;  ///< for lines and text [px of 96 dpi]
  bool legend = true;
  Theme theme = Theme::dark;
};

struct ChartImage {
  cv::Mat bgr;
  ChartMapping mapping;  ///< [px from the upper left corner, y down]
};

ChartImage draw_window_chart(const ChartRequest& request);

/// A chart of the window in graphics memory. Needs its context to be current.
class ChartView {
 public:
  /// Draws only after a change. The size must not be empty.
  void update(const ChartRequest& request);

  const ImageTexture& texture() const { return texture_; }
  const ChartMapping& mapping() const { return mapping_; }

 private:
  ChartRequest shown_;
  ChartMapping mapping_;
  ImageTexture texture_;
};

/// Draws the chart into the window in the current theme. Returns its mapping to the screen [px].
ChartMapping draw_chart_view(const Area& area,
                             ChartView& view,
                             const Chart& chart,
                             bool legend = true);

/// Draws a vertical line at `x` if it is within the axis.
void draw_chart_cursor(ImDrawList& list, const ChartMapping& to, double x, std::uint32_t rgb);

/// Lists the curves' values nearest to `x`, one per line, below the value of the x axis.
std::string chart_values_at(const Chart& chart, double x);

/// Returns a line per point: the curve's name, x, y, and its band. Unknown values are empty.
std::string to_csv(const Chart& chart);

/// Residuals of inliers [px] by frame of the window, zero in the reference frame; empty if failed.
using WindowResiduals = std::vector<std::vector<double>>;
WindowResiduals window_residuals(const Inspection& inspection);

/// Returns histograms of the residuals of the window and of a frame (counted in the recording) [%].
Chart residual_histogram(const WindowResiduals& residuals, const Inspection& inspection, int frame);

/// Returns the RMS residual over the frames, and the residuals of a track (null: none).
Chart rms_chart(const WindowResiduals& residuals,
                const Inspection& inspection,
                const TrackLife* track);

struct SolverRun {
  std::string name;
  std::uint32_t rgb;
  const SolverReport* report;
};

/// Returns cost, gradient and step over the iterations of the runs with a trace.
std::array<Chart, 3> solver_charts(std::span<const SolverRun> runs);

}  // namespace gpo
