// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/gyro_calibration.h"

#include "engine/frontend/homography_rotations.h"
#include "engine/geometry/pose.h"

#include <algorithm>
#include <vector>

#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLeastSigma_rad = 0.001;  // of visual rotations, by drifting tracks

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

GyroBias fit_gyro_bias(const Gyroscope& given,
                       std::span<const std::int64_t> frame_times_ns,
                       const Rotations& visual) {
  constexpr double kStep_rad_s = 1e-4;  // the rotations are all but linear in the bias
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
  Rotations visual = averaged_rotations(window, R_wc_given, stop);
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
