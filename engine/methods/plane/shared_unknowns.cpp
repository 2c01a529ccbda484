// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/shared_unknowns.h"

#include "engine/geometry/pose.h"

namespace gpo {

GyroColumns gyro_columns(const Window& window, const PlaneMotion& motion, int frame, int unknowns) {
  GyroColumns columns(3, unknowns);
  if (unknowns == 0) return columns;
  columns.leftCols<3>() = window.gyro->d_bias[frame];
  if (unknowns == 4) columns.col(3) = window.gyro->d_offset[frame];
  columns = so3_right_jacobian(gyro_correction_rad(window, frame, motion)) * columns;
  if (!motion.gyro_noise_rad.empty()) columns = so3_exp(-motion.gyro_noise_rad[frame]) * columns;
  return columns;
}

PlaneColumns plane_columns(int plane, const Eigen::Vector3d& tau_c, const GyroColumns& gyro) {
  const int size = UnknownsLayout::size_of_plane(plane);
  PlaneColumns columns = PlaneColumns::Zero(8, size + gyro.cols());
  columns.topLeftCorner<2, 2>().setIdentity();
  if (plane > 0) columns.col(2).tail<3>() = tau_c;
  columns.block(2, size, 3, gyro.cols()) = gyro;
  return columns;
}

}  // namespace gpo
