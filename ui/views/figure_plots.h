// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/views/curve_style.h"

class vtkChartXY;
class vtkRectf;

namespace gpo {

/// Whether the chart has a value that can be drawn; on a logarithmic axis these are positive.
bool has_values(const Chart& chart);

/// Grid, bands, curves and axes with their ticks, with the axes on the sides of `axes` [px, y up];
/// no titles. `scale`: of lines and text [px of 96 dpi].
void fill_chart(vtkChartXY& vtk,
                const Chart& chart,
                const std::vector<CurveStyle>& styles,
                const vtkRectf& axes,
                double scale);

}  // namespace gpo
