// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/pipeline/method_defaults.h"

namespace gpo {

bool uses_ransac(const InitializeOptions& options) {
  return options.ransac.value_or(options.method.row().needs_plane);
}

Inliers inliers_used(const InitializeOptions& options) {
  return options.inliers.value_or(options.method.row().inliers);
}

Gravity gravity_used(const InitializeOptions& options) {
  const bool joins = !options.method.row().rotations;
  return options.gravity == Gravity::joint && !joins ? Gravity::after : options.gravity;
}

InertialOptions inertial_options(const InitializeOptions& options) {
  return {.bias_sigma_m_s2 = options.accelerometer_bias_sigma_m_s2};
}

RansacOptions ransac_options(const InitializeOptions& options) {
  RansacOptions ransac;
  ransac.enabled = uses_ransac(options) || !options.method.row().needs_plane;
  ransac.threshold_px = options.ransac_threshold_px;
  ransac.seed = options.seed;
  return ransac;
}

}  // namespace gpo
