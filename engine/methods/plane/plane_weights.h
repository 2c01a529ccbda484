// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/method_options.h"
#include "engine/methods/plane/plane_motion.h"

namespace gpo {

/// Knee of the Huber loss [standard deviations of a coordinate].
inline constexpr double kHuberSigmas = 1.345;

/// Returns the transfer of observation `k`.
Transfer transfer_of(const FrameObservations& f, const FrameState& state, int k);
Eigen::Vector2d transfer_error_px(const FrameObservations& f, const FrameState& state, int k);

/// Returns true if the options require weights other than one.
bool is_weighted(const MethodOptions& options);

/// Sets the weights of iteratively reweighted least squares: for the Huber loss with its knee at
/// 1.345 standard deviations `sigma_px` of a coordinate's noise; for Sampson's error
/// r^T (I + J J^T)^-1 r with J the transfer's Jacobian over the reference pixel (engine/method.md,
/// eq. 10), scaled so that a stationary camera has weight one.
void reweigh(const PlaneMotion& motion,
             const MethodOptions& options,
             double sigma_px,
             PlaneObservations& observations);

/// Returns the excess of the Huber loss over the cost of the reweighted least squares,
/// k (|r| - k) / 2 beyond the knee k: the sum of both is comparable between different weights. Zero
/// for the squared loss, and for Sampson's error, whose weights hardly differ.
double loss_beyond_weights(const PlaneMotion& motion,
                           const MethodOptions& options,
                           double sigma_px,
                           const PlaneObservations& observations);

/// Returns `frame_normals`, or the same with the observations' weight matrices if they have them.
FrameNormals weighted_normals(const FrameObservations& f,
                              const FrameState& state,
                              Rotating rotating);

/// Returns the weight matrix of an observation's gradient.
Eigen::Matrix2d weight_of(const FrameObservations& f, int k);
/// Returns the second derivative of an observation's loss over its error `r`. Beyond the knee of
/// Huber's loss, k |r| has no curvature along the error and k / |r| across it, while the weights of
/// the least squares, k / |r| in both directions, would be overconfident.
Eigen::Matrix2d curvature_of(const FrameObservations& f, int k, const Eigen::Vector2d& r);
/// Adds an observation's normal equations; JtJ is the second derivative of its loss.
void add_curved(const FrameObservations& f, const FrameState& state, int k, FrameNormals& sum);
/// Returns the sum of these over all observations of a frame.
FrameNormals curved_normals(const FrameObservations& f, const FrameState& state);

}  // namespace gpo
