// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/common/initialization.h"

#include <utility>

namespace gpo {

Initialization failed(std::string reason, SolverReport solver) {
  Initialization result;
  result.reason = std::move(reason);
  result.solver = std::move(solver);
  return result;
}

void continue_trace(const SolverReport& before, SolverReport& next) {
  std::vector<SolverStep> trace = before.trace;
  if (!next.trace.empty()) trace.insert(trace.end(), next.trace.begin() + 1, next.trace.end());
  next.trace = std::move(trace);
  next.initial_cost = before.initial_cost;
}

}  // namespace gpo
