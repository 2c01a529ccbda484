// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Lens models. `lens_models` has their names and coefficients.
enum class Distortion {
  none,
  radial_tangential,   ///< Brown, rational, thin prism and tilted sensor, as in OpenCV
  equidistant,         ///< Kannala and Brandt
  double_sphere,       ///< Usenko et al. 2018
  extended_unified,    ///< Khomutenko et al. 2016 (EUCM); with beta 1 the unified model
  omnidirectional,     ///< Mei and Rives 2007
  field_of_view,       ///< Devernay and Faugeras 2001
  thin_prism_fisheye,  ///< equidistant, then Brown and thin prism, as in COLMAP
};

using Coefficients = std::span<const double>;

struct LensModel {
  Distortion distortion;
  const char* name;                 ///< in EuRoC's files, bags, JSON and Python
  const char* coefficients;         ///< names in order
  std::vector<std::size_t> counts;  ///< accepted numbers of coefficients
  /// Maps (x / z, y / z) to its distorted counterpart, with slope 1 at the principal point. This
  /// and its inverse return NaN beyond the valid radius.
  Eigen::Vector2d (*distort)(Coefficients k, const Eigen::Vector2d& x);
  Eigen::Vector2d (*undistort)(Coefficients k, const Eigen::Vector2d& distorted, double tolerance);
};

/// Returns all lens models in the order of `Distortion`.
const std::vector<LensModel>& lens_models();
const LensModel& lens_model(Distortion distortion);

}  // namespace gpo
