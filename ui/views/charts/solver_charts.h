// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "engine/methods/common/initialization.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace gpo {

/// A solver's run, as it is drawn.
struct SolverRun {
  std::string name;
  std::uint32_t rgb;
  const SolverReport* report;
};

/// Cost, gradient and step over the iterations, logarithmic. Runs without a trace are left out.
std::array<Chart, 3> solver_charts(std::span<const SolverRun> runs);

}  // namespace gpo
