// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/similarity.h"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace gpo {

Eigen::Vector3d operator*(const Similarity& T_ab, const Eigen::Vector3d& x_b) {
  return T_ab.scale * (T_ab.R_ab * x_b) + T_ab.t_ab;
}

Similarity align(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  const Eigen::Matrix4d T = Eigen::umeyama(from, to, true);
  Similarity similarity;
  similarity.scale = std::cbrt(T.topLeftCorner<3, 3>().determinant());
  similarity.R_ab = T.topLeftCorner<3, 3>() / similarity.scale;
  similarity.t_ab = T.topRightCorner<3, 1>();
  return similarity;
}

Alignment determined_alignment(const Eigen::Matrix3Xd& path, double reference_length) {
  const Eigen::Matrix3Xd centered = path.colwise() - path.rowwise().mean();
  const Eigen::Matrix3d covariance = centered * centered.transpose() / path.cols();
  const Eigen::Vector3d deviation =  // ascending
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance)
          .eigenvalues()
          .cwiseMax(0)
          .cwiseSqrt();
  if (!(deviation(2) > 1e-3 * reference_length)) return Alignment::point;
  return deviation(1) < 0.02 * deviation(2) ? Alignment::line : Alignment::ok;
}

}  // namespace gpo
