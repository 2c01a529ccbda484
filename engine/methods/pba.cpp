// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/bundle/bundle_adjustment.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/initializers.h"

#include <cmath>

namespace gpo {
namespace {

Initialization result_on_plane(const Window& window, const AdjustedPlaneBundle& adjusted) {
  Initialization result;
  result.plane = {adjusted.bundle.normal, 1};
  result.cameras = adjusted.bundle.cameras;
  const Bundle points = free_bundle(window.K, adjusted.bundle);
  for (int j = 0; j < window.track_count(); ++j) {
    if (!window.is_inlier_track(j)) continue;
    result.points.push_back({j, position(window.K, points.points.col(j))});
  }
  result.solver = adjusted.solver;
  // An observation has two residuals.
  result.rms_px = std::sqrt(4 * adjusted.solver.final_cost / adjusted.solver.residuals);
  return result;
}

template <PlaneNormal normal>
Initialization initialize_on_plane(const Window& window, const Watch& watch) {
  const Refinement refine = [](const Window& w, const Initialization& start, const Watch& s) {
    return refine_on_plane(w, start, normal, s);
  };
  return refined_start(window, {"DBSCAN", initialize_dbscan}, refine, watch);
}

}  // namespace

Initialization refine_on_plane(const Window& window,
                               const Initialization& start,
                               PlaneNormal normal,
                               const Watch& watch) {
  const PlaneBundle bundle{start.cameras, start.plane.normal, window.points_px[0]};
  const auto is_inlier = [&](int frame, int track) { return bool{window.inlier[frame][track]}; };
  const AdjustedPlaneBundle adjusted =
      adjust_plane_bundle(window.K, bundle, track_observations(window, is_inlier), normal, watch);
  if (adjusted.solver.termination != Termination::convergence)
    return not_converged(adjusted.solver);
  return trusted(window, result_on_plane(window, adjusted));
}

Initialization initialize_pba(const Window& window, const Watch& watch) {
  return initialize_on_plane<PlaneNormal::free>(window, watch);
}

Initialization initialize_fpba(const Window& window, const Watch& watch) {
  return initialize_on_plane<PlaneNormal::held>(window, watch);
}

}  // namespace gpo
