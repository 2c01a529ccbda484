// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/residuals/point_view.h"

#include "engine/geometry/pose.h"

namespace gpo {
namespace {

/// Returns d(R^T v)/dq, columns x y z w, from R^T v = v - 2 w u x v + 2 u x (u x v), q = (u, w).
Eigen::Matrix<double, 3, 4> inverse_rotation_jacobian(const Eigen::Quaterniond& q,
                                                      const Eigen::Vector3d& v) {
  const Eigen::Vector3d u = q.vec();
  Eigen::Matrix<double, 3, 4> J;
  J.leftCols<3>() = 2 * (q.w() * skew(v) + u.dot(v) * Eigen::Matrix3d::Identity() +
                         u * v.transpose() - 2 * v * u.transpose());
  J.col(3) = -2 * u.cross(v);
  return J;
}

}  // namespace

PointView view_point(const Intrinsics& intrinsics,
                     const Eigen::Quaterniond& q_wci,
                     const Eigen::Vector3d& p_wci,
                     const Eigen::Vector2d& pixel_1,
                     double inverse_depth) {
  const Eigen::Matrix3d& K = intrinsics.K;
  const Eigen::Vector3d ray_1 = intrinsics.K_inverse * pixel_1.homogeneous();
  const Eigen::Vector3d v = ray_1 - inverse_depth * p_wci;
  const Eigen::Matrix3d R_cw = q_wci.toRotationMatrix().transpose();
  const Eigen::Vector3d y = R_cw * v;
  const Eigen::Vector2d x = y.hnormalized();
  Eigen::Matrix<double, 2, 3> d_y;  // dp/dy
  d_y << 1, 0, -x.x(), 0, 1, -x.y();
  d_y = K.topLeftCorner<2, 2>() * d_y / y.z();
  const Eigen::Matrix<double, 2, 3> d_v = d_y * R_cw;
  PointView view;
  view.pixel = K.topLeftCorner<2, 2>() * x + K.topRightCorner<2, 1>();
  view.d_rotation = d_y * inverse_rotation_jacobian(q_wci, v);
  view.d_position = -inverse_depth * d_v;
  view.d_pixel_1 = d_v * intrinsics.K_inverse.leftCols<2>();
  view.d_inverse_depth = -d_v * p_wci;
  view.in_front = y.z() > 0;
  return view;
}

PlaneDepth depth_on_plane(const Intrinsics& intrinsics,
                          const Eigen::Vector3d& normal,
                          const Eigen::Vector2d& pixel_1) {
  const Eigen::Vector3d ray_1 = intrinsics.K_inverse * pixel_1.homogeneous();
  return {-normal.dot(ray_1),
          -ray_1.transpose(),
          -normal.transpose() * intrinsics.K_inverse.leftCols<2>()};
}

}  // namespace gpo
