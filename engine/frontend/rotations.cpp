// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/rotations.h"

#include "engine/base/error.h"
#include "engine/geometry/pose.h"

#include <string>
#include <utility>

namespace gpo {
namespace {

/// Rotation from the gyroscope's axes now to those at the first frame, and how it moves with the
/// bias: R_first_now(bias + db) ~ R_first_now exp(d_bias db).
struct Turn {
  Eigen::Matrix3d R_first_now = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d d_bias = Eigen::Matrix3d::Zero();  ///< [s]
};

/// Goes on at a constant rate (Forster et al., "On-Manifold Preintegration", eq. 44 with its sum as
/// a recursion).
void advance(Turn& turn, const Eigen::Vector3d& rate_rad_s, double dt_s) {
  const Eigen::Vector3d step = rate_rad_s * dt_s;
  const Eigen::Matrix3d R_step = so3_exp(step);
  turn.R_first_now = turn.R_first_now * R_step;
  turn.d_bias = R_step.transpose() * turn.d_bias - so3_right_jacobian(step) * dt_s;
}

}  // namespace

bool needs_gyroscope(RotationSource source) {
  return source == RotationSource::gyro || source == RotationSource::gyro_calibrated;
}

Rotations sensitive_gyro_rotations(const Gyroscope& gyroscope,
                                   std::span<const std::int64_t> frame_times_ns) {
  std::vector<std::int64_t> times_ns(frame_times_ns.begin(), frame_times_ns.end());
  for (std::int64_t& t : times_ns) t += gyroscope.time_offset_ns;
  const std::string reason = why_not_covered(gyroscope, times_ns.front(), times_ns.back());
  if (!reason.empty()) throw InputError(reason);
  const Eigen::Matrix3d R_cg = gyroscope.R_gyro_camera.transpose();
  const auto rate = [&](std::int64_t t_ns) -> Eigen::Vector3d {
    return sample_at(gyroscope, t_ns).rate_rad_s - gyroscope.bias_rad_s;
  };
  const Eigen::Vector3d first_rate = rate(times_ns.front());
  Rotations rotations{.model = RotationModel::bias};
  const double sigma_rad_s = gyroscope.bias_sigma_rad_s;
  GyroSensitivity gyro{.bias_rad_s = gyroscope.bias_rad_s,
                       .prior_rad_s = gyroscope.bias_rad_s,
                       .prior_sigma_rad_s = sigma_rad_s,
                       .bias_covariance = sigma_rad_s * sigma_rad_s * Eigen::Matrix3d::Identity(),
                       .noise_density = gyroscope.noise_density,
                       .d_bias = {},
                       .d_offset = {}};
  Turn turn;
  const auto advance_turn = [&](const InertialSample& mean, double dt_s) {
    advance(turn, mean.rate_rad_s - gyroscope.bias_rad_s, dt_s);
  };
  for (std::size_t i = 0; i < times_ns.size(); ++i) {
    if (i > 0) integrate(gyroscope, times_ns[i - 1], times_ns[i], advance_turn);
    rotations.R_wc.push_back(R_cg * turn.R_first_now * R_cg.transpose());
    gyro.d_bias.push_back(R_cg * turn.d_bias);
    // A later clock drops the first frame's turn and adds the last one's:
    // exp(-w_1 dt) R exp(w_i dt) = R exp((w_i - R^T w_1) dt), all in the gyroscope's axes.
    gyro.d_offset.push_back(R_cg * (rate(times_ns[i]) - turn.R_first_now.transpose() * first_rate));
  }
  rotations.gyro = std::move(gyro);
  return rotations;
}

std::vector<Eigen::Matrix3d> gyro_rotations(const Gyroscope& gyroscope,
                                            std::span<const std::int64_t> frame_times_ns) {
  return sensitive_gyro_rotations(gyroscope, frame_times_ns).R_wc;
}

}  // namespace gpo
