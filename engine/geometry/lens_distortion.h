// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <Eigen/Core>

namespace gpo {

enum class Distortion { none, radial_tangential, equidistant };

/// A model of a lens and its coefficients, which belong to somebody else.
/// radial_tangential: k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tau_x tau_y]]]] (Brown, rational,
/// thin prism and tilted sensor, as OpenCV orders them);
/// equidistant: k1 k2 k3 k4 (Kannala-Brandt); none: empty. Missing ones are zero.
struct Lens {
  Distortion distortion = Distortion::none;
  std::span<const double> coefficients;
};

/// What the lens does to normalized coordinates (x / z, y / z): where the pinhole's point appears.
/// NaN beyond the model's valid radius, where the polynomial folds back and maps two directions to
/// one pixel.
Eigen::Vector2d distort_normalized(const Lens& lens, const Eigen::Vector2d& ideal);

/// The inverse, by Newton's method to `tolerance` (normalized). NaN where there is none within the
/// valid radius.
Eigen::Vector2d undistort_normalized(const Lens& lens,
                                     const Eigen::Vector2d& distorted,
                                     double tolerance);

}  // namespace gpo
