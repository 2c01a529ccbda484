// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/method_options.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/plane_observations.h"

namespace gpo {

/// Root of what Huber's weights leave of the mean square of two-dimensional Gaussian noise.
inline constexpr double kSigmaOfHuber = 0.8636;

/// Transfer of a frame's observation `k`.
Transfer transfer_of(const FrameObservations& f, const FrameState& state, int k);
/// Its distance from where the observation is.
Eigen::Vector2d transfer_error_px(const FrameObservations& f, const FrameState& state, int k);

/// Whether the options ask for weights other than one.
bool is_weighted(const MethodOptions& options);

/// Weights of iteratively reweighted least squares at a solution: of the Huber loss, with its knee
/// at 1.345 standard deviations of a coordinate's noise `sigma_px`; of Sampson's error,
/// r^T (I + J J^T)^-1 r with J the transfer's Jacobian over the reference pixel (engine/method.md,
/// eq. 10), scaled so that a camera at rest keeps weight one.
void reweigh(const PlaneMotion& motion,
             const MethodOptions& options,
             double sigma_px,
             PlaneObservations& observations);

/// By how much Huber's loss of all observations exceeds what iteratively reweighted least squares
/// minimize: k (|r| - k) / 2 beyond the knee k. Solutions with different weights compare by the
/// sum. Zero of the squared loss, and of Sampson's error, whose weights hardly differ.
double loss_beyond_weights(const PlaneMotion& motion,
                           const MethodOptions& options,
                           double sigma_px,
                           const PlaneObservations& observations);

/// The normal equations of a frame of which each observation has a weight matrix of its own.
FrameNormals frame_normals_by_matrix(const FrameObservations& observations,
                                     const FrameState& state);

}  // namespace gpo
