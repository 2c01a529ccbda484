// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "ui/views/charts/chart_mapping.h"
#include "ui/views/charts/curve_style.h"

#include <cstdint>
#include <vector>

class vtkChartXY;
class vtkRectf;

namespace gpo {

/// What stands around the curves.
struct ChartLook {
  std::uint32_t ground, text, axis, grid;
  double tick_text_px = 14;     ///< at scale 1
  double tick_spacing_px = 36;  ///< at least so much between ticks of the y axis, at scale 1
};

/// For the window: grid, bands, curves and axes with their ticks, with the axes on the sides of
/// `axes` [px, y up]; no titles. `scale`: of lines and text [px of 96 dpi]. Returns where the
/// values are.
ChartMapping fill_chart(vtkChartXY& vtk,
                        const Chart& chart,
                        const std::vector<CurveStyle>& styles,
                        const vtkRectf& axes,
                        double scale,
                        const ChartLook& look);

}  // namespace gpo
