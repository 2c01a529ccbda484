// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/palette.h"
#include "ui/views/charts/chart_mapping.h"
#include "ui/views/charts/curve_style.h"

class vtkChartXY;
class vtkRectf;

namespace gpo {

/// Whether the chart has a value that can be drawn; on a logarithmic axis these are positive.
bool has_values(const Chart& chart);

/// What stands around the curves.
struct ChartLook {
  std::uint32_t ground, text, axis, grid;
  double tick_text_px = 14;     ///< at scale 1
  double tick_spacing_px = 36;  ///< at least so much between ticks of the y axis, at scale 1
};
constexpr ChartLook kPaperLook{
    0xFFFFFF, palette::kInk, palette::kPaperAxis, palette::kPaperGrid, 14, 36};

/// Grid, bands, curves and axes with their ticks, with the axes on the sides of `axes` [px, y up];
/// no titles. `scale`: of lines and text [px of 96 dpi]. Returns where the values are.
ChartMapping fill_chart(vtkChartXY& vtk,
                        const Chart& chart,
                        const std::vector<CurveStyle>& styles,
                        const vtkRectf& axes,
                        double scale,
                        const ChartLook& look = kPaperLook);

}  // namespace gpo
