// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace gpo {

inline constexpr int kLensMonomials = 7;  ///< degrees 2 and 3 in the pixel
using LensMonomials = Eigen::Matrix<double, kLensMonomials, 1>;

/// Returns the monomials of a pixel relative to the principal point [distance of a corner].
inline LensMonomials lens_monomials(const Eigen::Vector2d& p) {
  const double x = p.x(), y = p.y();
  LensMonomials all;
  all << x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
  return all;
}

/// Smooth error that a calibrated lens leaves: seen = p + error(p).
struct LensResidual {
  Eigen::Matrix<double, kLensMonomials, 2> coefficients_px;  ///< one column per coordinate
  double corner_px = 1;  ///< distance of a corner from the principal point

  /// Returns the error at a pixel relative to the principal point [px].
  Eigen::Vector2d error_px(const Eigen::Vector2d& p_px) const {
    return coefficients_px.transpose() * lens_monomials(p_px / corner_px);
  }
};

}  // namespace gpo
