// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/plane_motion.h"

#include <cmath>

#include <Eigen/Geometry>

namespace gpo {

PlaneMotion motion_without_translation(const Window& window) {
  PlaneMotion motion;
  motion.normal = Eigen::Vector3d::UnitZ();
  motion.tau.assign(window.frame_count(), Eigen::Vector3d::Zero());
  motion.R_wc = window.R_wc;
  if (window.gyro) motion.bias_rad_s = window.gyro->bias_rad_s;
  return motion;
}

PlaneMotion motion_of(const Plane& plane, std::span<const Pose> cameras) {
  PlaneMotion motion;
  motion.normal = plane.normal;
  for (const Pose& camera : cameras) {
    motion.tau.push_back(-camera.p_wc / plane.distance);
    motion.R_wc.push_back(camera.R_wc);
  }
  return motion;
}

PlaneMotion facing(const Window& window, PlaneMotion motion) {
  const Eigen::Matrix3d& K = window.K;
  int in_front = 0;
  for (const int j : window.inlier_tracks(0)) {
    const Eigen::Vector2d& p = window.points_px[0].col(j);
    const Eigen::Vector3d ray((p.x() - K(0, 2)) / K(0, 0), (p.y() - K(1, 2)) / K(1, 1), 1);
    in_front += motion.normal.dot(ray) < 0 ? 1 : -1;
  }
  if (in_front > 0) return motion;
  motion.normal = -motion.normal;
  for (OtherPlane& other : motion.others) other.m = -other.m;
  for (Eigen::Vector3d& tau : motion.tau) tau = -tau;
  return motion;
}

Eigen::Vector3d gyro_correction_rad(const Window& window, int frame, const PlaneMotion& motion) {
  const GyroSensitivity& gyro = *window.gyro;
  Eigen::Vector3d by_bias = gyro.d_bias[frame] * (motion.bias_rad_s - gyro.bias_rad_s);
  const double dt_s = motion.time_offset_correction_s;
  if (dt_s == 0) return by_bias;
  return by_bias + dt_s * (gyro.d_offset[frame] + 0.5 * dt_s * gyro.d2_offset[frame]);
}

Eigen::Matrix3d gyro_rotation(const Window& window, int frame, const PlaneMotion& motion) {
  const Eigen::Matrix3d R =
      window.R_wc[frame] * so3_exp(gyro_correction_rad(window, frame, motion));
  return motion.gyro_noise_rad.empty() ? R : R * so3_exp(motion.gyro_noise_rad[frame]);
}

double gyro_noise_sigma_rad(const Window& window, int frame) {
  const auto ns = static_cast<double>(window.timestamps_ns[frame] - window.timestamps_ns[0]);
  return window.gyro->noise_density * std::sqrt(1e-9 * ns);
}

FrameState frame_state(const PlaneObservations& observations,
                       const PlaneMotion& motion,
                       int frame,
                       int plane) {
  const Eigen::Matrix3d R_cw = motion.R_wc[frame].transpose();
  FrameState state{.R_cw = R_cw,
                   .tau_c = R_cw * motion.tau[frame],
                   .normal = motion.normal,
                   .fx = observations.fx,
                   .fy = observations.fy};
  if (plane == 0) {
    state.tangents = normal_tangents(motion.normal);
  } else {
    state.normal = motion.others[plane - 1].m;
    state.tangents = state.normal.norm() * normal_tangents(state.normal.normalized());
  }
  return state;
}

Eigen::Vector3d moved_normal(const Eigen::Vector3d& normal, const Eigen::Vector2d& u_rad) {
  const double angle = u_rad.norm();
  const double sinc = angle < 1e-8 ? 1.0 : std::sin(angle) / angle;
  return (std::cos(angle) * normal + sinc * (normal_tangents(normal) * u_rad)).normalized();
}

int gyro_unknowns(const Window& window, RotationModel rotations) {
  if (rotations != RotationModel::bias) return 0;
  return window.gyro->time_offset_sigma_s > 0 ? 4 : 3;
}

GyroColumns gyro_columns(const Window& window, const PlaneMotion& motion, int frame, int unknowns) {
  GyroColumns columns(3, unknowns);
  if (unknowns == 0) return columns;
  columns.leftCols<3>() = window.gyro->d_bias[frame];
  if (unknowns == 4)
    columns.col(3) = window.gyro->d_offset[frame] +
                     motion.time_offset_correction_s * window.gyro->d2_offset[frame];
  columns = so3_right_jacobian(gyro_correction_rad(window, frame, motion)) * columns;
  if (!motion.gyro_noise_rad.empty()) columns = so3_exp(-motion.gyro_noise_rad[frame]) * columns;
  return columns;
}

GyroVector gyro_prior_sigmas(const Window& window, int unknowns) {
  if (unknowns == 0) return {};
  GyroVector sigmas = GyroVector::Constant(unknowns, window.gyro->prior_sigma_rad_s);
  if (unknowns == 4) sigmas(3) = window.gyro->time_offset_sigma_s;
  return sigmas;
}

GyroVector gyro_prior_errors(const Window& window, int unknowns, const PlaneMotion& motion) {
  if (unknowns == 0) return {};
  Eigen::Vector4d errors;
  errors << motion.bias_rad_s - window.gyro->prior_rad_s, motion.time_offset_correction_s;
  return errors.head(unknowns);
}

void move_shared(const UnknownsLayout& layout,
                 const Eigen::Ref<const Eigen::VectorXd>& step,
                 PlaneMotion& motion) {
  motion.normal = moved_normal(motion.normal, step.head<2>());
  for (int k = 0; k < layout.others; ++k) {
    Eigen::Vector3d& m = motion.others[k].m;
    const Eigen::Vector3d u_s = step.segment<3>(UnknownsLayout::of_plane(k + 1));
    const double length = m.norm();
    m = length * std::exp(u_s(2)) * moved_normal(m / length, u_s.head<2>());
  }
  if (layout.gyro > 0) motion.bias_rad_s += step.segment<3>(layout.of_gyro());
  if (layout.gyro == 4) motion.time_offset_correction_s += step(layout.of_gyro() + 3);
}

void move_frame(const Window& window,
                int gyro,
                int frame,
                const Eigen::Ref<const Eigen::VectorXd>& step,
                PlaneMotion& motion) {
  Eigen::Matrix3d& R_wc = motion.R_wc[frame];
  motion.tau[frame] += R_wc * step.tail<3>();
  if (step.size() == 6) {
    const Eigen::Matrix3d turn = so3_exp(step.head<3>());
    if (motion.gyro_noise_rad.empty())
      R_wc = R_wc * turn;
    else
      motion.gyro_noise_rad[frame] = so3_log(so3_exp(motion.gyro_noise_rad[frame]) * turn);
  }
  if (gyro > 0) R_wc = gyro_rotation(window, frame, motion);
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
