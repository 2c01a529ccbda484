// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/common/initialization.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

namespace gpo {

void set_normal_covariance(const Eigen::Matrix3d& covariance, Uncertainty& uncertainty) {
  const double before_deg = uncertainty.normal_sigma_deg;
  const double now_deg = degrees(std::sqrt(std::max(0.0, covariance.trace())));
  uncertainty.normal_covariance = covariance;
  uncertainty.normal_sigma_deg = now_deg;
  auto& typical_deg = uncertainty.typical_lens_sigma_deg;
  if (!typical_deg) return;
  const double of_lens_deg2 = *typical_deg * *typical_deg - before_deg * before_deg;
  typical_deg = std::sqrt(now_deg * now_deg + std::max(0.0, of_lens_deg2));
}

double normal_sigma_deg(const Uncertainty& uncertainty, Lens lens) {
  const double exact_deg = uncertainty.normal_sigma_deg;
  return lens == Lens::exact ? exact_deg : uncertainty.typical_lens_sigma_deg.value_or(exact_deg);
}

void set_plane_uncertainties(Initialization& result) {
  if (!result.uncertainty || result.planes.empty()) return;
  result.planes[0].normal_covariance = result.uncertainty->normal_covariance;
  result.planes[0].distance_sigma = 0;
  for (std::size_t k = 0; k < result.uncertainty->others.size(); ++k) {
    PlaneEstimate& plane = result.planes[k + 1];
    const PlaneUncertainty& u = result.uncertainty->others[k];
    plane.normal_covariance = u.normal_covariance;
    plane.distance_sigma = u.log_distance_sigma * plane.plane.distance;
  }
}

Initialization failed(std::string reason, SolverReport solver) {
  Initialization result;
  result.reason = std::move(reason);
  result.solver = std::move(solver);
  return result;
}

Initialization refused(std::string reason, Initialization found) {
  Initialization result = failed(std::move(reason), std::move(found.solver));
  result.candidates = std::move(found.candidates);
  result.verdict = std::move(found.verdict);
  result.ambiguity = std::move(found.ambiguity);
  result.refused = std::move(found.refused);
  if (!found.cameras.empty()) result.refused = {found.plane, std::move(found.cameras)};
  return result;
}

Initialization not_converged(SolverReport solver) {
  std::string reason = fmt::format("no convergence after {} iterations", solver.iterations);
  return failed(std::move(reason), std::move(solver));
}

Initialization stopped_early() {
  Initialization result = failed("stopped");
  result.stopped = true;
  return result;
}

void continue_trace(const SolverReport& before, SolverReport& next) {
  std::vector<SolverStep> trace = before.trace;
  if (!next.trace.empty()) trace.insert(trace.end(), next.trace.begin() + 1, next.trace.end());
  next.trace = std::move(trace);
  next.initial_cost = before.initial_cost;
}

}  // namespace gpo
