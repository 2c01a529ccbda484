// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initialize/steps.h"

#include "engine/initializers/certainty/growth.h"
#include "engine/initializers/methods.h"

#include <utility>

namespace gpo {

bool uses_ransac(const InitializeOptions& options) {
  return options.ransac.value_or(find_method(options.method).needs_plane);
}

Inliers inliers_used(const InitializeOptions& options) {
  return options.inliers.value_or(find_method(options.method).inliers);
}

Gravity gravity_used(const InitializeOptions& options) {
  const bool joins = !find_method(options.method).rotations;
  return options.gravity == Gravity::joint && !joins ? Gravity::after : options.gravity;
}

RansacOptions ransac_options(const InitializeOptions& options) {
  RansacOptions ransac;
  ransac.enabled = uses_ransac(options) || !find_method(options.method).needs_plane;
  ransac.threshold_px = options.ransac_threshold_px;
  ransac.seed = options.seed;
  return ransac;
}

Window with_rotations(Window window, const Rotations& rotations, bool all_tracks) {
  window.all_tracks = all_tracks;
  window.rotations = rotations.model;
  window.gyro = rotations.gyro;
  if (!rotations.R_wc.empty()) window.R_wc = rotations.R_wc;
  return window;
}

std::vector<Verdict> growing_verdicts(const Window& window, const std::stop_token& stop) {
  std::vector<Verdict> verdicts;
  for (GrowthStep& step : grow(window, stop)) verdicts.push_back(std::move(step.verdict));
  return verdicts;
}

void complete_verdict(const Window& window,
                      std::span<const Verdict> growth,
                      Initialization& result) {
  if (!result.verdict && static_cast<int>(growth.size()) == window.frame_count() - 1 &&
      !growth.empty())
    result.verdict = growth.back();
  if (window.inliers == Inliers::planes && window.planes.empty()) {
    Verdict verdict;
    verdict.readiness = Readiness::no_plane;
    verdict.reason = result.reason;
    verdict.scene = SceneKind::no_plane;
    result.verdict = std::move(verdict);
  }
}

void demote(Verdict& verdict) {
  if (verdict.readiness != Readiness::ready) return;
  verdict.readiness = Readiness::weak;
  verdict.reason = "the camera is a guess: calibrate it";
}

}  // namespace gpo
