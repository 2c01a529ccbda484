// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/chart_ticks.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace gpo {
namespace {

constexpr int kFewestTicks = 3;

struct Extent {
  double low = INFINITY, high = -INFINITY;

  void take(std::span<const double> values, bool logarithmic) {
    for (const double value : values) {
      if (!std::isfinite(value) || (logarithmic && value <= 0)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  bool empty() const { return low > high; }
};

Extent x_extent(const Chart& chart) {
  Extent extent;
  for (const Curve& curve : chart.curves) extent.take(curve.x, false);
  return extent;
}

Extent y_extent(const Chart& chart) {
  Extent extent;
  for (const Curve& curve : chart.curves)
    for (const auto* values : {&curve.y, &curve.lower, &curve.upper})
      extent.take(*values, chart.logarithmic);
  return extent;
}

int most_ticks(double length, double spacing) {
  return std::max(kFewestTicks, static_cast<int>(length / spacing));
}

}  // namespace

bool has_values(const Chart& chart) { return !x_extent(chart).empty() && !y_extent(chart).empty(); }

AxisTicks x_ticks(const Chart& chart, double length, double spacing) {
  const Extent extent = x_extent(chart);
  const double room = 0.03 * (extent.high - extent.low);
  return linear_ticks(extent.low - room, extent.high + room, most_ticks(length, spacing));
}

AxisTicks y_ticks(const Chart& chart, double length, double spacing) {
  const Extent extent = y_extent(chart);
  const int most = most_ticks(length, spacing);
  if (chart.logarithmic) return logarithmic_ticks(extent.low, extent.high, most);
  const double low = std::min(0.0, extent.low);
  const double room = 0.05 * (extent.high - low);
  return linear_ticks(low < 0 ? low - room : 0, extent.high + room, most);
}

}  // namespace gpo
