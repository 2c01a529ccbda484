// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/trajectory.h"

#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace gpo {
namespace {

/// Value, first and second derivative.
template <int N>
std::array<Eigen::Matrix<double, N, 1>, 3> derivatives(const Path<N>& path, double seconds) {
  std::array<Eigen::Matrix<double, N, 1>, 3> d = {
      path.start + path.velocity * seconds, path.velocity, Eigen::Matrix<double, N, 1>::Zero()};
  for (const auto& harmonic : path.harmonics) {
    const double w = 2 * std::numbers::pi * harmonic.frequency;
    const double angle = w * seconds + harmonic.phase;
    d[0] += harmonic.amplitude * std::sin(angle);
    d[1] += harmonic.amplitude * (w * std::cos(angle));
    d[2] -= harmonic.amplitude * (w * w * std::sin(angle));
  }
  return d;
}

/// A unit vector and its derivative, from a vector and its derivative.
struct Direction {
  Eigen::Vector3d value;
  Eigen::Vector3d rate;
};
Direction normalized(const Eigen::Vector3d& v, const Eigen::Vector3d& v_rate) {
  const double length = v.norm();
  const Eigen::Vector3d unit = v / length;
  return {unit, (v_rate - unit * unit.dot(v_rate)) / length};
}

}  // namespace

CameraMotion camera_motion(const Trajectory& trajectory, double seconds) {
  const auto position = derivatives(trajectory.position, seconds);
  const auto look_at = derivatives(trajectory.look_at, seconds);
  const auto roll = derivatives(trajectory.roll, seconds);

  // Axes of a camera without roll: z forward, x = z x up, y = z x x.
  const Direction z = normalized(look_at[0] - position[0], look_at[1] - position[1]);
  const Direction x = normalized(z.value.cross(trajectory.up), z.rate.cross(trajectory.up));
  Eigen::Matrix3d R;
  R << x.value, z.value.cross(x.value), z.value;
  const Eigen::Vector3d y_rate = z.rate.cross(x.value) + z.value.cross(x.rate);

  // dR/dt = R [w]x: the rates are the products of axes and derivatives of axes.
  const Eigen::Vector3d rate(R.col(2).dot(y_rate), R.col(0).dot(z.rate), R.col(1).dot(x.rate));
  const Eigen::Matrix3d R_roll =
      Eigen::AngleAxisd(roll[0](0), Eigen::Vector3d::UnitZ()).toRotationMatrix();

  CameraMotion motion;
  motion.pose = {R * R_roll, position[0]};
  motion.velocity_w = position[1];
  motion.acceleration_w = position[2];
  motion.rate_c = R_roll.transpose() * rate + Eigen::Vector3d(0, 0, roll[1](0));
  return motion;
}

BodyMotion body_motion(const Trajectory& trajectory, const Pose& T_body_camera, double seconds) {
  const CameraMotion camera = camera_motion(trajectory, seconds);
  // The angular acceleration, for the accelerometer only, is by differences.
  const double step = 1e-4;
  const Eigen::Vector3d rate_change_c = (camera_motion(trajectory, seconds + step).rate_c -
                                         camera_motion(trajectory, seconds - step).rate_c) /
                                        (2 * step);
  const Pose T_camera_body = inverse(T_body_camera);
  const Eigen::Vector3d& lever_c = T_camera_body.p_wc;
  const Eigen::Vector3d spin_c = camera.rate_c.cross(lever_c);
  const Eigen::Vector3d acceleration_w =
      camera.acceleration_w +
      camera.pose.R_wc * (rate_change_c.cross(lever_c) + camera.rate_c.cross(spin_c));

  BodyMotion body;
  body.pose = camera.pose * T_camera_body;
  body.velocity_w = camera.velocity_w + camera.pose.R_wc * spin_c;
  body.rate_b = T_body_camera.R_wc * camera.rate_c;
  body.specific_force_b =
      body.pose.R_wc.transpose() * (acceleration_w + Eigen::Vector3d(0, 0, 9.81));
  return body;
}

}  // namespace gpo
