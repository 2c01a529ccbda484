// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/solver_charts.h"

namespace gpo {
namespace {

Curve curve_of(const SolverRun& run, double SolverStep::*value) {
  Curve curve{run.name, run.rgb, false, {}, {}, {}, {}};
  for (const SolverStep& step : run.report->trace) {
    curve.x.push_back(static_cast<double>(curve.x.size()));
    curve.y.push_back(step.*value);
  }
  return curve;
}

}  // namespace

std::array<Chart, 3> solver_charts(std::span<const SolverRun> runs) {
  std::array<Chart, 3> charts = {
      Chart{"Cost", "iteration", "half the sum of squares [px\u00b2]", true, {}},
      Chart{"Gradient", "iteration", "largest component [px\u00b2]", true, {}},
      Chart{"Step", "iteration", "length over all unknowns [-]", true, {}}};
  for (const SolverRun& run : runs) {
    if (run.report->trace.empty()) continue;
    charts[0].curves.push_back(curve_of(run, &SolverStep::cost));
    charts[1].curves.push_back(curve_of(run, &SolverStep::gradient));
    charts[2].curves.push_back(curve_of(run, &SolverStep::step));
  }
  return charts;
}

}  // namespace gpo
