// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/chart_csv.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

std::string label(std::string text) {
  std::ranges::replace(text, ',', ';');
  return text;
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.9g}", value) : "";
}

}  // namespace

std::string to_csv(const Chart& chart) {
  const bool band =
      std::ranges::any_of(chart.curves, [](const Curve& curve) { return !curve.lower.empty(); });
  std::string text = fmt::format(
      "curve,{},{}{}\n", label(chart.x_label), label(chart.y_label), band ? ",lower,upper" : "");
  for (const Curve& curve : chart.curves) {
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      text += fmt::format("{},{},{}", label(curve.name), number(curve.x[i]), number(curve.y[i]));
      if (band && curve.lower.empty()) text += ",,";
      if (!curve.lower.empty())
        text += fmt::format(",{},{}", number(curve.lower[i]), number(curve.upper[i]));
      text += '\n';
    }
  }
  return text;
}

}  // namespace gpo
