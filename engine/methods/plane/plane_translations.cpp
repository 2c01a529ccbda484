// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/plane_translations.h"

#include "engine/geometry/decompositions.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// With y = R_ciw (x_1 - tau (n.x_1)), (u, v, 1) ~ y gives the rows (e_1 - u e_3).y = 0 and
// (e_2 - v e_3).y = 0; divided by y_z of the round before they are pixel errors.
Vector3d translation_given_normal(const Window& window, int frame, const Vector3d& normal) {
  const Matrix3d K_inverse = window.K.inverse();
  const Matrix3d R_ciw = window.R_wc[frame].transpose();
  Vector3d tau = Vector3d::Zero();
  for (int round = 0; round < 3; ++round) {
    Matrix3d AtA = Matrix3d::Zero();
    Vector3d Atb = Vector3d::Zero();
    for (int j = 0; j < window.track_count(); ++j) {
      if (!window.inlier[frame][j]) continue;
      const Vector3d ray_1 = K_inverse * window.points_px[0].col(j).homogeneous();
      const Vector3d seen = K_inverse * window.points_px[frame].col(j).homogeneous();
      const double height = normal.dot(ray_1);
      Eigen::Matrix<double, 2, 3> rows;
      rows << window.K(0, 0), 0, -window.K(0, 0) * seen.x(), 0, window.K(1, 1),
          -window.K(1, 1) * seen.y();
      rows = rows * R_ciw / R_ciw.row(2).dot(ray_1 - tau * height);
      AtA += height * height * rows.transpose() * rows;
      Atb += height * rows.transpose() * (rows * ray_1);
    }
    tau = solve_symmetric(AtA, Atb);
  }
  return tau;
}

}  // namespace gpo
