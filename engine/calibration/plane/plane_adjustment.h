// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_views.h"
#include "engine/calibration/plane/plane_unknowns.h"
#include "engine/geometry/camera.h"

#include <vector>

#include <Eigen/Core>

namespace gpo {

Camera camera_of(const LensVector& lens, int width, int height);
LensVector lens_of(const Camera& camera);

/// Least squares over the lens, all points and all poses (engine/method.md, 19). Of each plane two
/// points are held, which is the gauge.
Adjustment adjust(const std::vector<ObservedPlane>& planes,
                  const GyroRotations& gyro,
                  int width,
                  int height,
                  const Adjustment& start,
                  const LensPrior& prior,
                  const PlaneAdjustmentOptions& options);

/// Lengths of the errors [px], one an observation: plane, sight, point. Infinite behind the camera.
using ViewErrors = std::vector<std::vector<Eigen::VectorXd>>;
ViewErrors view_errors(const std::vector<ObservedPlane>& planes,
                         int width,
                         int height,
                         const Adjustment& adjustment);

/// How sure the lens is.
struct LensCertainty {
  LensVector sigma;      ///< robust
  LensVector own_sigma;  ///< as if all observations were independent
};

/// Of an adjusted lens (engine/method.md, 20): what is wrong with a point, or with a stretch of
/// time (a tenth of the sights), counts as one thing that is wrong. `noise_px` is that of one
/// coordinate.
LensCertainty lens_certainty(const std::vector<ObservedPlane>& planes,
                             const GyroRotations& gyro,
                             int width,
                             int height,
                             const Adjustment& adjustment,
                             const LensPrior& prior,
                             double noise_px,
                             const PlaneAdjustmentOptions& options);

}  // namespace gpo
