// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/transfer.h"
#include "engine/methods/plane/plane_observations.h"

#include <Eigen/Core>

namespace gpo {

/// Gauss-Newton's normal equations of one frame's transfer errors (engine/method.md, eq. 7) over
/// (u, phi, t), of 2, 3 and 3 numbers: normal [+] tangents u, R_wc exp(phi), tau + R_wc t.
struct FrameNormals {
  Eigen::Matrix<double, 8, 8> JtJ = Eigen::Matrix<double, 8, 8>::Zero();  ///< [px^2]
  Eigen::Matrix<double, 8, 1> Jtr = Eigen::Matrix<double, 8, 1>::Zero();  ///< [px^2]
  double cost = 0;        ///< half the summed squares [px^2]
  bool in_front = false;  ///< all points before the camera; else the rest is worthless
};

enum class Rotating { no, yes };  ///< no: the rows and columns of phi are left at zero

/// One pass over the observations, as wide as this processor is.
FrameNormals frame_normals(const FrameObservations& observations,
                           const FrameState& state,
                           Rotating rotating);

/// The versions that it chooses from.
FrameNormals frame_normals_baseline(const FrameObservations& observations,
                                    const FrameState& state,
                                    Rotating rotating);
/// Only where `has_avx2_fma` (engine/base/processor.h).
FrameNormals frame_normals_avx2_fma(const FrameObservations& observations,
                                    const FrameState& state,
                                    Rotating rotating);

}  // namespace gpo
