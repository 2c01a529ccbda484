// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/pba.h"

#include "engine/methods/common/refined_start.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/dbscan.h"

#include <cmath>

namespace gpo {
namespace {

/// The inlier observations, and the reference frame's of every track that has one; points are the
/// window's tracks.
std::vector<Observation> inlier_observations(const Window& window) {
  std::vector<Observation> observations;
  for (int j = 0; j < window.track_count(); ++j) {
    const std::size_t before = observations.size();
    for (int i = 1; i < window.frame_count(); ++i) {
      if (window.inlier[i][j]) observations.push_back({i, j, window.points_px[i].col(j)});
    }
    if (observations.size() > before) observations.push_back({0, j, window.points_px[0].col(j)});
  }
  return observations;
}

Initialization make_result(const Window& window, const AdjustedPlaneBundle& adjusted) {
  Initialization result;
  result.plane = {adjusted.bundle.normal, 1};
  result.cameras = adjusted.bundle.cameras;
  const Bundle points = free_bundle(window.K, adjusted.bundle);
  for (int j = 0; j < window.track_count(); ++j) {
    if (!window.is_inlier_track(j)) continue;
    result.points.push_back({j, position(window.K, points.points.col(j))});
  }
  result.solver = adjusted.solver;
  // Two residuals an observation.
  result.rms_px = std::sqrt(4 * adjusted.solver.final_cost / adjusted.solver.residuals);
  return result;
}

}  // namespace

Initialization refine_on_plane(const Window& window,
                               const Initialization& start,
                               PlaneNormal normal,
                               const Watch& watch) {
  const PlaneBundle bundle{start.cameras, start.plane.normal, window.points_px[0]};
  const AdjustedPlaneBundle adjusted =
      adjust_plane_bundle(window.K, bundle, inlier_observations(window), normal, watch);
  const SolverReport& solver = adjusted.solver;
  if (solver.termination != Termination::convergence) return not_converged(solver);
  return trusted(window, make_result(window, adjusted));
}

Initialization initialize_pba(const Window& window, const Watch& watch) {
  const Refinement refine = [](const Window& w, const Initialization& start, const Watch& s) {
    return refine_on_plane(w, start, PlaneNormal::free, s);
  };
  return refined_start(window, {"DBSCAN", initialize_dbscan}, refine, watch);
}

}  // namespace gpo
