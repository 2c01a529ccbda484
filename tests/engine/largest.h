// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace gpo::test {

/// Returns the largest absolute value, NaN if there is one, which Eigen's `maxCoeff()` would drop:
/// `EXPECT_LT(largest(x), limit)` fails for NaN.
template <class Derived>
double largest(const Eigen::DenseBase<Derived>& values) {
  return values.derived().cwiseAbs().template maxCoeff<Eigen::PropagateNaN>();
}

}  // namespace gpo::test
