// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/method_options.h"

#include <functional>
#include <memory>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <ceres/ceres.h>

namespace gpo {

template <int Rows, int Columns>
using RowMajor = Eigen::Matrix<double, Rows, Columns, Eigen::RowMajor>;

/// Returns the direction n = q e_z q* of a unit quaternion with the two-dimensional tangent space
/// q [+] u = exp(N u) q, where the columns of N are q's images of e_x and e_y (Bloesch et al.
/// 2016).
Eigen::Vector3d direction(const Eigen::Quaterniond& q);
/// Returns dn/dq, columns in Eigen's order x y z w.
Eigen::Matrix<double, 3, 4> direction_jacobian(const Eigen::Quaterniond& q);

/// Manifold of `direction`; `Minus` returns the u for which y and x [+] u have the same direction.
class DirectionManifold : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 4; }
  int TangentSize() const override { return 2; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

struct SolverTolerances {
  double cost = 1e-12;      ///< relative change of the cost [-]
  double gradient = 1e-12;  ///< largest component of the gradient [px^2 per unit of the unknown]
};

/// Reads the plane's normal from the unknowns, for the trace.
using ReadNormal = std::function<Eigen::Vector3d()>;

/// Solves by dogleg with a Schur complement, tuned as in the paper: at most 300 iterations, one
/// thread for bitwise repeatability. Eliminates group 0 of the ordering first and stops within an
/// iteration of a request. Calls `normal` after each iteration.
///
/// Ceres sorts the blocks of a group by their addresses, and their order decides how sums round.
/// So the blocks of a group must be elements of one array: addresses of the stack and the heap
/// compare differently from thread to thread.
SolverReport solve_by_schur(ceres::Problem& problem,
                            std::shared_ptr<ceres::ParameterBlockOrdering> ordering,
                            const SolverTolerances& tolerances,
                            const Watch& watch,
                            const ReadNormal& normal = {});

}  // namespace gpo
