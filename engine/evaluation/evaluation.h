// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/eigen_layout.h"
#include "engine/methods/common/initialization.h"
#include "engine/truth/truth.h"

namespace gpo {

/// Returns the number of the window's plane that the truth describes: the one with most tracks, 0,
/// unless those of another plane agree three times better with the homographies of the true poses
/// and plane. nullopt if none of them is within five thresholds of inliers.
std::optional<int> plane_of_truth(const Window& window, const WindowTruth& truth);

/// Errors of an initialization. Unknown ones are nullopt: ATE, scale and PDE if the true path is a
/// point, the aligned PNE also if it is a line; all plane errors if the true plane or the reference
/// pose is unknown.
struct Evaluation {
  Alignment alignment = Alignment::ok;   ///< determined by the true camera path
  std::optional<Similarity> T_true_est;  ///< estimate -> truth's world
  std::optional<double> scale;           ///< meters per unit of the estimate
  std::optional<double> ate_m;
  std::optional<double> pne_deg;
  std::optional<double> pne_aligned_deg;
  std::optional<double> pde_m;
  std::optional<double> pne_bound_deg;
  /// Errors of the accelerometer's metric scale and gravity; gravity only if the world is upright.
  std::optional<double> scale_error_percent;
  std::optional<double> gravity_error_deg;
};

/// Evaluates an initialization that is `ok` (engine/method.md, "Metrics"). `seed` drives the plane
/// RANSAC.
Evaluation evaluate(const Initialization& initialization,
                    const Window& window,
                    const WindowTruth& truth,
                    std::uint64_t seed);

}  // namespace gpo
