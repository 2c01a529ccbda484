// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

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

struct LensModel {
  Distortion distortion;
  const char* name;                 ///< in EuRoC's files, bags, JSON and Python
  const char* coefficients;         ///< names in order
  std::vector<std::size_t> counts;  ///< accepted numbers of coefficients
};

/// Returns all lens models in the order of `Distortion`.
const std::vector<LensModel>& lens_models();
const LensModel& lens_model(Distortion distortion);

/// Returns a coefficient outside of the range in which the model is defined, for people.
std::optional<std::string> fault_of(Distortion distortion, std::span<const double> coefficients);

}  // namespace gpo
