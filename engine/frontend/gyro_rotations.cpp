// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/frontend/rotations.h"
#include "engine/geometry/pose.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLeastSigma_rad = 0.001;  // for visual rotations, because tracks drift

std::vector<Vector3d> residuals_rad(Gyroscope& gyroscope,
                                    const Vector3d& bias_rad_s,
                                    std::span<const std::int64_t> frame_times_ns,
                                    std::span<const Matrix3d> R_wc_visual) {
  gyroscope.bias_rad_s = bias_rad_s;
  const std::vector<Matrix3d> R_wc = gyro_rotations(gyroscope, frame_times_ns);
  std::vector<Vector3d> residuals;
  for (std::size_t i = 1; i < R_wc.size(); ++i)
    residuals.push_back(so3_log(R_wc[i].transpose() * R_wc_visual[i]));
  return residuals;
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
  const Matrix3d R_cg = gyroscope.R_gyro_camera.transpose();
  const auto rate = [&](std::int64_t t_ns) -> Vector3d {
    return sample_at(gyroscope, t_ns).rate_rad_s - gyroscope.bias_rad_s;
  };
  const Vector3d first_rate = rate(times_ns.front());
  Rotations rotations{.model = RotationModel::bias};
  const double held_rad_s = held_bias_sigma_rad_s(gyroscope);
  GyroSensitivity gyro{.bias_rad_s = gyroscope.bias_rad_s,
                       .prior_rad_s = gyroscope.bias_rad_s,
                       .prior_sigma_rad_s = gyroscope.bias_sigma_rad_s,
                       .bias_covariance = held_rad_s * held_rad_s * Matrix3d::Identity(),
                       .noise_density = gyroscope.noise_density,
                       .d_bias = {},
                       .d_offset = {}};
  // Rotation since the first frame: R_first_now(bias + db) ~ R_first_now exp(d_bias db).
  Matrix3d R_first_now = Matrix3d::Identity(), d_bias = Matrix3d::Zero();
  // Forster et al., "On-Manifold Preintegration", eq. 44 with its sum as a recursion.
  const auto advance = [&](const InertialSample& mean, double dt_s) {
    const Vector3d step = (mean.rate_rad_s - gyroscope.bias_rad_s) * dt_s;
    const Matrix3d R_step = so3_exp(step);
    R_first_now = R_first_now * R_step;
    d_bias = R_step.transpose() * d_bias - so3_right_jacobian(step) * dt_s;
  };
  for (std::size_t i = 0; i < times_ns.size(); ++i) {
    if (i > 0) integrate(gyroscope, times_ns[i - 1], times_ns[i], advance);
    rotations.R_wc.push_back(R_cg * R_first_now * R_cg.transpose());
    gyro.d_bias.push_back(R_cg * d_bias);
    // A later clock drops the rotation at the first frame and adds that at the last one:
    // exp(-w_1 dt) R exp(w_i dt) = R exp((w_i - R^T w_1) dt), all in the gyroscope's axes.
    gyro.d_offset.push_back(R_cg * (rate(times_ns[i]) - R_first_now.transpose() * first_rate));
  }
  rotations.gyro = std::move(gyro);
  return rotations;
}

std::vector<Matrix3d> gyro_rotations(const Gyroscope& gyroscope,
                                     std::span<const std::int64_t> frame_times_ns) {
  return sensitive_gyro_rotations(gyroscope, frame_times_ns).R_wc;
}

GyroBias fit_gyro_bias(const Gyroscope& given,
                       std::span<const std::int64_t> frame_times_ns,
                       const Rotations& visual) {
  constexpr double kStep_rad_s = 1e-4;  // the rotations are almost linear in the bias
  const double sigma_rad = std::max(visual.sigma_rad, kLeastSigma_rad);
  Gyroscope gyroscope = given;
  Vector3d bias = given.bias_rad_s;
  Matrix3d covariance;
  for (int round = 0; round < 20; ++round) {
    const auto residuals = residuals_rad(gyroscope, bias, frame_times_ns, visual.R_wc);
    std::vector<Matrix3d> J(residuals.size());
    for (int k = 0; k < 3; ++k) {
      const Vector3d step = kStep_rad_s * Vector3d::Unit(k);
      const auto moved = residuals_rad(gyroscope, bias + step, frame_times_ns, visual.R_wc);
      for (std::size_t i = 0; i < J.size(); ++i)
        J[i].col(k) = (moved[i] - residuals[i]) / kStep_rad_s;
    }
    const double prior = 1 / (given.bias_sigma_rad_s * given.bias_sigma_rad_s);
    Matrix3d JtJ = prior * Matrix3d::Identity();
    Vector3d Jtr = prior * (bias - given.bias_rad_s);
    for (std::size_t i = 0; i < J.size(); ++i) {
      const double huber = 1 / std::max(residuals[i].norm() / sigma_rad, 1.0);
      const double weight = huber / (sigma_rad * sigma_rad * static_cast<double>(residuals.size()));
      JtJ += weight * J[i].transpose() * J[i];
      Jtr += weight * J[i].transpose() * residuals[i];
    }
    covariance = JtJ.inverse();
    const Vector3d step = -covariance * Jtr;
    bias += step;
    if (step.norm() < 1e-9) break;
  }
  return {bias, covariance};
}

Rotations calibrated_gyro_rotations(const Gyroscope& gyroscope,
                                    const Window& window,
                                    const std::stop_token& stop) {
  const std::vector<Matrix3d> R_wc_given = gyro_rotations(gyroscope, window.timestamps_ns);
  Rotations visual = averaged_rotations(window, stop, R_wc_given);
  if (visual.R_wc.empty()) return visual;
  Gyroscope calibrated = gyroscope;
  const GyroBias fitted = fit_gyro_bias(gyroscope, window.timestamps_ns, visual);
  calibrated.bias_rad_s = fitted.bias_rad_s;
  Rotations rotations = sensitive_gyro_rotations(calibrated, window.timestamps_ns);
  rotations.gyro->prior_rad_s = gyroscope.bias_rad_s;
  rotations.gyro->bias_covariance = fitted.covariance;
  return rotations;
}

}  // namespace gpo
