// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "ui/views/charts/axis_ticks.h"

namespace gpo {

/// Whether the chart has a value that can be drawn; on a logarithmic axis these are positive.
bool has_values(const Chart& chart);

/// Of an axis of that length, with at least `spacing` between ticks where these are more than
/// three; room for markers at both ends. The chart has values.
AxisTicks x_ticks(const Chart& chart, double length, double spacing);
/// The same; errors are drawn from zero on.
AxisTicks y_ticks(const Chart& chart, double length, double spacing);

}  // namespace gpo
