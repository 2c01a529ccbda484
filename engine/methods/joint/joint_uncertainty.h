// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Standard deviations of the joint model, estimated from the window itself, and of its solution.
#include "engine/methods/common/initialization.h"
#include "engine/methods/joint/joint_model.h"

namespace gpo::joint {

/// Returns the noise of a coordinate in all frames but the reference frame: the median length of
/// the errors, over 1.1774 [px].
double noise_px(const Model& model, const Predictions& predictions);

/// Returns the noise of the reference positions: their distance from where the other frames place
/// the tracks, without the noise of those [px]. `at` has the weights that led to the predictions.
double reference_noise_px(const Model& model,
                          const Predictions& predictions,
                          const Normals& at,
                          const Scales& scales);

/// Sets the most likely standard deviation of the lens residual (empirical Bayes, engine/method.md,
/// eq. 28), with `at` linearized where it is held at zero.
void find_lens_residual(const Model& model, const State& state, const Normals& at, Scales& scales);

/// Returns the uncertainty of a solution: the cluster-robust covariance with tracks as clusters and
/// the contribution of the priors (engine/method.md, eq. 29). `at` has the curvature of the loss.
Uncertainty uncertainty_of(const Model& model,
                           const State& state,
                           const Normals& at,
                           const Scales& scales);

}  // namespace gpo::joint
