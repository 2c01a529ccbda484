// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/pose.h"

#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace gpo {

Pose operator*(const Pose& T_ab, const Pose& T_bc) {
  return {T_ab.R_wc * T_bc.R_wc, T_ab.R_wc * T_bc.p_wc + T_ab.p_wc};
}

Pose inverse(const Pose& pose) {
  return {pose.R_wc.transpose(), -(pose.R_wc.transpose() * pose.p_wc)};
}

Eigen::Vector3d to_world(const Pose& pose, const Eigen::Vector3d& point_c) {
  return pose.R_wc * point_c + pose.p_wc;
}

Eigen::Vector3d to_camera(const Pose& pose, const Eigen::Vector3d& point_w) {
  return pose.R_wc.transpose() * (point_w - pose.p_wc);
}

Eigen::Matrix3d so3_exp(const Eigen::Vector3d& rotation_rad) {
  const double square = rotation_rad.squaredNorm();
  if (square < 1e-3) {  // power series, exact to rounding
    const double sine = 1 - square / 6 * (1 - square / 20 * (1 - square / 42));
    const double cosine = 0.5 * (1 - square / 12 * (1 - square / 30 * (1 - square / 56)));
    Eigen::Matrix3d R = cosine * rotation_rad * rotation_rad.transpose();
    R.diagonal().array() += 1 - cosine * square;
    const Eigen::Vector3d v = sine * rotation_rad;
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3, last = (k + 2) % 3;
      R(last, next) += v(k);
      R(next, last) -= v(k);
    }
    return R;
  }
  const double angle = std::sqrt(square);
  return Eigen::AngleAxisd(angle, rotation_rad / angle).toRotationMatrix();
}

Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd angle_axis{Eigen::Quaterniond(rotation).normalized()};
  return angle_axis.angle() * angle_axis.axis();
}

Eigen::Matrix3d so3_right_jacobian(const Eigen::Vector3d& rotation_rad) {
  const double angle = rotation_rad.norm();
  const Eigen::Matrix3d V = skew(rotation_rad);
  if (angle < 1e-4) return Eigen::Matrix3d::Identity() - V / 2 + V * V / 6;  // error < angle^3 / 24
  const double sine_half = std::sin(angle / 2);
  return Eigen::Matrix3d::Identity() - 2 * sine_half * sine_half / (angle * angle) * V +
         (angle - std::sin(angle)) / (angle * angle * angle) * V * V;
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return degrees(std::atan2(a.cross(b).norm(), a.dot(b)));
}

double radians(double degrees) { return degrees * std::numbers::pi / 180; }
double degrees(double radians) { return radians * 180 / std::numbers::pi; }

Eigen::Vector3d operator*(const Similarity& T_ab, const Eigen::Vector3d& x_b) {
  return T_ab.scale * (T_ab.R_ab * x_b) + T_ab.t_ab;
}

Similarity align(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  const Eigen::Matrix4d T = Eigen::umeyama(from, to, true);
  const double scale = std::cbrt(T.topLeftCorner<3, 3>().determinant());
  return {scale, T.topLeftCorner<3, 3>() / scale, T.topRightCorner<3, 1>()};
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
