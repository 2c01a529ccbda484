// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/plane_result.h"
#include "engine/methods/plane/rolling_shutter.h"
#include "engine/methods/uncertainty/shares.h"
#include "engine/pipeline/method_defaults.h"
#include "engine/pipeline/pipeline.h"

#include <cmath>
#include <utility>

namespace gpo {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

struct JointRows {
  Index frames;
  Index gyro;

  static Index of_center(Index frame) { return 3 * (frame - 1); }
  Index of_gyro() const { return 3 * (frames - 1); }
  Index of_plane(int plane) const { return of_gyro() + gyro + UnknownsLayout::of_plane(plane); }
};

Plane moved_plane(const Plane& plane, const VectorXd& step) {
  Plane moved{moved_normal(plane.normal, step.head<2>()), plane.distance};
  if (step.size() == 3) moved.distance *= std::exp(-step(2));
  return moved;
}

Matrix3d lowered(const Matrix3d& covariance, const Vector3d& normal, const MatrixXd& less) {
  const auto tangents = normal_tangents(normal);
  return covariance - tangents * less.topLeftCorner<2, 2>() * tangents.transpose();
}

/// Lowers the normal's covariance and, by the same factor, all parts of its standard deviation.
void lower_normal(const MatrixXd& less, Initialization& result) {
  Uncertainty& u = *result.uncertainty;
  const double before_deg = u.normal_sigma_deg;
  set_normal_covariance(lowered(u.normal_covariance, result.plane.normal, less), u);
  const double kept = before_deg > 0 ? u.normal_sigma_deg / before_deg : 1;
  for (auto* part_deg : {&u.neighbors_sigma_deg,
                         &u.bend_sigma_deg,
                         &u.clock_sigma_deg,
                         &u.shutter_sigma_deg,
                         &u.lens_sigma_deg})
    if (*part_deg) **part_deg *= kept;
}

void lower_covariances(const JointRows& rows, const MatrixXd& less, Initialization& result) {
  Uncertainty& u = *result.uncertainty;
  const Index leading = rows.of_plane(0);
  lower_normal(less.block<2, 2>(leading, leading), result);
  for (std::size_t k = 0; k < u.others.size(); ++k) {
    const Index at = rows.of_plane(static_cast<int>(k) + 1);
    Matrix3d& covariance = u.others[k].normal_covariance;
    covariance = lowered(covariance, result.planes[k + 1].plane.normal, less.block<2, 2>(at, at));
  }
  add_to_marginals(motion_of(result.plane, result.cameras), -less, u);
  u.joint_covariance -= less;
  u.pose_covariance.resize(0, 0);  // no longer valid: the rotations move
}

void move(const Window& window, const JointRows& rows, const VectorXd& step, Initialization& r) {
  PlaneMotion before;
  if (window.gyro) before.bias_rad_s = r.bias_rad_s.value_or(window.gyro->bias_rad_s);
  before.time_offset_correction_s = r.time_offset_correction_s.value_or(0);
  for (Index i = 1; i < rows.frames; ++i) {
    Pose& camera = r.cameras[i];
    camera.p_wc += step.segment<3>(JointRows::of_center(i));
    if (rows.gyro == 0 || !window.gyro) continue;
    const int gyro = static_cast<int>(rows.gyro);
    const GyroColumns by_gyro = gyro_columns(window, before, static_cast<int>(i), gyro);
    camera.R_wc = camera.R_wc * so3_exp(by_gyro * step.segment(rows.of_gyro(), gyro));
  }
  if (r.bias_rad_s && rows.gyro > 0) *r.bias_rad_s += step.segment<3>(rows.of_gyro());
  for (auto* offset_s : {&r.time_offset_s, &r.time_offset_correction_s})
    if (*offset_s && rows.gyro > 3) **offset_s += step(rows.of_gyro() + 3);
  r.plane = moved_plane(r.plane, step.segment(rows.of_plane(0), 2));
  if (!r.planes.empty()) r.planes.front().plane = r.plane;
  for (std::size_t k = 1; k < r.planes.size(); ++k)
    r.planes[k].plane =
        moved_plane(r.planes[k].plane, step.segment(rows.of_plane(static_cast<int>(k)), 3));
}

/// Returns the result updated by the accelerations (engine/method.md, eq. 25); nullopt if that is
/// no solution of the window.
std::optional<Initialization> pulled(const Window& window,
                                     const Initialization& result,
                                     const UncertainPoses& poses,
                                     const PosePull& pull) {
  const JointRows rows{std::ssize(result.cameras), result.uncertainty->joint_bias_rows};
  const MatrixXd& covariance = result.uncertainty->joint_covariance;
  // A bias that is not among the rows is correlated with none of them.
  MatrixXd with_poses = MatrixXd::Zero(covariance.rows(), pull.gradient.size());
  for (std::size_t k = 0; k < poses.joint_rows.size(); ++k)
    with_poses.col(static_cast<Index>(k)) = covariance.col(poses.joint_rows[k]);
  Initialization moved = result;
  lower_covariances(rows, with_poses * pull.information * with_poses.transpose(), moved);
  move(window, rows, -with_poses * pull.gradient, moved);
  set_plane_uncertainties(moved);
  Window seen = as_seen_at_time_stamps(window, moved);
  if (moved.lens_residual) seen = without_lens_residual(std::move(seen), *moved.lens_residual);
  moved = with_map_points(seen, std::move(moved));
  return moved.ok ? std::optional(std::move(moved)) : std::nullopt;
}

}  // namespace

InertialAlignment find_gravity(const Window& window,
                               const Sources& sources,
                               const UncertainPoses& poses,
                               const InitializeOptions& options,
                               Initialization& result) {
  const bool joint = gravity_used(options) == Gravity::joint && !poses.joint_rows.empty();
  PosePull pull;
  InertialAlignment inertial = align_inertial(poses,
                                              *sources.gyroscope,
                                              sources.T_body_camera,
                                              inertial_options(options),
                                              joint ? &pull : nullptr);
  if (!joint || !inertial.ok) return inertial;
  auto moved = pulled(window, result, poses, pull);
  if (!moved) return inertial;
  result = std::move(*moved);
  inertial.joint = true;
  return inertial;
}

}  // namespace gpo
