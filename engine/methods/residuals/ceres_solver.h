// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/watch.h"

#include <functional>
#include <memory>

#include <ceres/ceres.h>

namespace gpo {

/// The unit quaternion of a direction; its tangent is two-dimensional (Bloesch et al.).
class DirectionManifold : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 4; }
  int TangentSize() const override { return 2; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

/// What ends a solve.
struct SolverTolerances {
  double cost = 1e-12;      ///< relative change of the cost [-]
  double gradient = 1e-12;  ///< largest component of the gradient [px^2 per unit of the unknown]
};

/// Reads the plane's normal off the unknowns, for the trace.
using ReadNormal = std::function<Eigen::Vector3d()>;

/// Dogleg with a Schur complement, as the paper tunes it: at most 300 iterations, one thread so
/// that it repeats to the bit. Group 0 of the ordering is eliminated first. Also ends within
/// an iteration of a request to stop. `normal` is called with the unknowns of each iteration.
SolverReport solve_by_schur(ceres::Problem& problem,
                            std::shared_ptr<ceres::ParameterBlockOrdering> ordering,
                            const SolverTolerances& tolerances,
                            const Watch& watch,
                            const ReadNormal& normal = {});

}  // namespace gpo
