// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace gpo {

/// A direction kept as a unit quaternion q, n = q e_z q*, with a two-dimensional tangent: q [+] u =
/// exp(N u) q, where N holds q's images of e_x and e_y (Bloesch et al. 2016).
Eigen::Vector3d direction(const Eigen::Quaterniond& q);
/// dn/dq, columns in Eigen's order x y z w.
Eigen::Matrix<double, 3, 4> direction_jacobian(const Eigen::Quaterniond& q);
Eigen::Quaterniond direction_plus(const Eigen::Quaterniond& q, const Eigen::Vector2d& u);
/// d(q [+] u)/du at u = 0, rows in Eigen's order x y z w.
Eigen::Matrix<double, 4, 2> direction_plus_jacobian(const Eigen::Quaterniond& q);
/// The u with y = x [+] u as directions.
Eigen::Vector2d direction_minus(const Eigen::Quaterniond& y, const Eigen::Quaterniond& x);

}  // namespace gpo
