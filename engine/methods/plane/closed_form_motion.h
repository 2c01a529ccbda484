// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/plane/plane_motion.h"
#include "engine/window/window.h"

#include <optional>

#include <Eigen/Core>

namespace gpo {

/// tau n^T of a frame, the rank-one part I - H' / lambda of its homography; not finite where it has
/// none.
Eigen::Matrix3d translation_times_normal(const Window& window, int frame);

/// Normal and translations from all homographies at once, without a choice among decompositions:
/// I - H'_i / lambda_i = tau_i n^T with H'_i = R_wci K^-1 H_i1 K and lambda_i its middle singular
/// value; stacked over the frames, the matrix has rank one and n is its right singular vector
/// (engine/method.md, eq. 8). Its sign is that of a visible plane. Nothing where a homography is
/// missing.
std::optional<PlaneMotion> closed_form_motion(const Window& window);

}  // namespace gpo
