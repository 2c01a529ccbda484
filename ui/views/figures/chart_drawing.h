// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "ui/views/charts/curve_style.h"
#include "ui/views/figures/drawing.h"
#include "ui/views/figures/figure_layout.h"

namespace gpo {

/// Grid, axes, ticks, bands, curves and titles of a chart, within and around `axes`. `styles`: one
/// a name.
void draw_chart(Drawing& drawing,
                const Chart& chart,
                const std::vector<CurveStyle>& styles,
                const cv::Rect2d& axes,
                const FigureType& type,
                double scale);

/// A piece of a curve with its marker, from its left end on.
void draw_sample(Drawing& drawing,
                 const CurveStyle& style,
                 const Eigen::Vector2d& at,
                 double scale);

/// A marker; hollow: of few windows.
void draw_marker(Drawing& drawing,
                 int marker,
                 const Eigen::Vector2d& at,
                 double size,
                 std::uint32_t rgb,
                 bool hollow);

}  // namespace gpo
