// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "simulated_motion.h"

#include "engine/inertial/preintegration.h"

#include <cmath>
#include <random>

namespace gpo {

using Eigen::Matrix3d, Eigen::Vector3d;

namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr double kSampleRate_hz = 200;
constexpr double kFrameRate_hz = 20;

Vector3d sines(
    const Vector3d& a, const Vector3d& w, const Vector3d& phase, double t, double shift) {
  return a.array() * (w.array() * t + phase.array() + shift).sin();
}

struct Dice {
  std::mt19937 engine;
  std::normal_distribution<double> normal;
  Vector3d gaussian() { return {normal(engine), normal(engine), normal(engine)}; }
  Vector3d uniform(double least, double most) {
    std::uniform_real_distribution<double> of(least, most);
    return {of(engine), of(engine), of(engine)};
  }
};

/// Adds measurements from two samples before to two after.
void add_samples(const SimulatedMotion& motion,
                 const SimulatedSensor& sensor,
                 double seconds,
                 double noise,
                 const Vector3d& gyro_bias,
                 Dice& dice,
                 SimulatedAlignment& made) {
  Gyroscope& gyro = made.gyroscope;
  gyro.file = "simulated.csv";
  gyro.R_gyro_camera = made.T_body_camera.R_wc;
  gyro.noise_density = sensor.gyroscope_density;
  const double per_sample = noise * std::sqrt(kSampleRate_hz);
  Dice of_factors = dice;
  const Vector3d factors = Vector3d::Ones() + sensor.scale_factor_sigma * of_factors.gaussian();
  const double gravity =
      kGravity_m_s2 * (1 + sensor.gravity_sigma * of_factors.normal(of_factors.engine));
  for (int k = -2; k <= static_cast<int>(seconds * kSampleRate_hz) + 2; ++k) {
    const double t = k / kSampleRate_hz;
    gyro.timestamps_ns.push_back(1000000000 + static_cast<std::int64_t>(std::llround(t * 1e9)));
    gyro.lines.push_back(k + 3);
    gyro.rates_rad_s.emplace_back(motion.rate(t) + gyro_bias +
                                  per_sample * sensor.gyroscope_density * dice.gaussian());
    gyro.accelerations_m_s2.emplace_back(
        factors.cwiseProduct(motion.rotation(t).transpose() *
                             (motion.acceleration(t) + gravity * Vector3d::UnitZ())) +
        made.accelerometer_bias + per_sample * sensor.accelerometer_density * dice.gaussian());
  }
}

}  // namespace

Vector3d SimulatedMotion::position(double t) const {
  return sines(amplitude_m, speed_rad_s, phase, t, 0);
}
Vector3d SimulatedMotion::velocity(double t) const {
  return speed_rad_s.cwiseProduct(sines(amplitude_m, speed_rad_s, phase, t, M_PI / 2));
}
Vector3d SimulatedMotion::acceleration(double t) const {
  return -speed_rad_s.cwiseAbs2().cwiseProduct(position(t));
}
Matrix3d SimulatedMotion::rotation(double t) const {
  return R_first * so3_exp(sines(swing_rad, swing_speed_rad_s, swing_phase, t, 0));
}
Vector3d SimulatedMotion::rate(double t) const {
  const Vector3d swing = sines(swing_rad, swing_speed_rad_s, swing_phase, t, 0);
  return so3_right_jacobian(swing) * swing_speed_rad_s.cwiseProduct(sines(
                                         swing_rad, swing_speed_rad_s, swing_phase, t, M_PI / 2));
}

SimulatedMotion simulated_motion(Pace pace, unsigned seed) {
  Dice dice{std::mt19937(seed), {}};
  const double reach_m = pace == Pace::still ? 0 : pace == Pace::gentle ? 0.12 : 0.35;
  const double turn_rad = pace == Pace::still ? 0 : pace == Pace::gentle ? 0.1 : 0.3;
  SimulatedMotion motion;
  motion.amplitude_m = dice.uniform(0.3 * reach_m, reach_m);
  motion.speed_rad_s = dice.uniform(1.5, pace == Pace::brisk ? 5 : 3);
  motion.phase = dice.uniform(0, 2 * M_PI);
  motion.swing_rad = dice.uniform(0.3 * turn_rad, turn_rad);
  motion.swing_speed_rad_s = dice.uniform(1.5, 4);
  motion.swing_phase = dice.uniform(0, 2 * M_PI);
  motion.R_first = so3_exp(dice.uniform(-1.5, 1.5));
  return motion;
}

SimulatedAlignment simulated_alignment(
    Pace pace, const SimulatedSensor& sensor, double seconds, unsigned seed, double noise) {
  const SimulatedMotion motion = simulated_motion(pace, seed);
  Dice dice{std::mt19937(seed + 77777), {}};
  SimulatedAlignment made;
  made.T_body_camera = {so3_exp(dice.uniform(-1, 1)), Vector3d(0.02, -0.06, 0.01)};
  made.accelerometer_bias = noise * sensor.accelerometer_bias_sigma * dice.gaussian();
  const Vector3d gyro_bias = 0.02 * dice.gaussian();
  made.options.bias_sigma_m_s2 = sensor.accelerometer_bias_sigma;
  made.options.noise_density = sensor.accelerometer_density;
  made.options.scale_factor_sigma = sensor.scale_factor_sigma;
  made.options.gravity_sigma = sensor.gravity_sigma;
  add_samples(motion, sensor, seconds, noise, gyro_bias, dice, made);

  const int frames = static_cast<int>(seconds * kFrameRate_hz) + 1;
  const Vector3d lever =
      made.T_body_camera.p_wc + noise * made.options.calibrated_lever_sigma_m * dice.gaussian();
  const auto camera = [&](double t) {
    return Pose{motion.rotation(t) * made.T_body_camera.R_wc,
                motion.position(t) + motion.rotation(t) * lever};
  };
  const Pose T_first_world = inverse(camera(0));
  made.scale = std::uniform_real_distribution<double>(0.8, 3)(dice.engine);
  made.gravity = T_first_world.R_wc * Vector3d(0, 0, -kGravity_m_s2);
  // Errors of the centers: noise of each frame, and a part that grows with time and motion.
  const double own_sigma = 4e-4;
  const double shared_sigma = 3e-3;
  const Vector3d shared = noise * shared_sigma * dice.gaussian();
  const Vector3d bias_error = noise * sensor.gyroscope_bias_sigma * dice.gaussian();
  const Eigen::Index rows = 3 * (frames - 1);
  Eigen::MatrixXd by_shared = Eigen::MatrixXd::Zero(rows + 3, 3);
  made.poses.bias_rad_s = gyro_bias + bias_error;
  made.centers_and_bias.resize(rows + 3);
  made.centers_and_bias.tail<3>() = gyro_bias;
  for (int i = 0; i < frames; ++i) {
    const double t = i / kFrameRate_hz;
    made.poses.times_ns.push_back(1000000000 + static_cast<std::int64_t>(std::llround(t * 1e9)));
    Pose pose = T_first_world * camera(t);
    made.velocities.emplace_back(T_first_world.R_wc * motion.velocity(t));
    pose.p_wc /= made.scale;
    if (i > 0) {
      const Matrix3d grows = (t / seconds) * Matrix3d::Identity() + skew(pose.p_wc) * (t / seconds);
      by_shared.middleRows<3>(3 * (i - 1)) = grows;
      made.centers_and_bias.segment<3>(3 * (i - 1)) = pose.p_wc;
      pose.p_wc += grows * shared + noise * own_sigma * dice.gaussian();
    }
    made.poses.cameras.push_back(pose);
  }
  // The rotations are the gyroscope's with the estimated bias.
  const Matrix3d& R_gc = made.gyroscope.R_gyro_camera;
  const auto between =
      imu_intervals(made.gyroscope, made.poses.times_ns, 0, *made.poses.bias_rad_s, {}).between;
  const std::vector<InertialFrame> path = inertial_path(between, R_gc.transpose());
  for (int i = 0; i < frames; ++i) made.poses.cameras[i].R_wc = path[i].R * R_gc;
  made.poses.covariance = shared_sigma * shared_sigma * by_shared * by_shared.transpose();
  made.poses.covariance.diagonal().head(rows).array() += own_sigma * own_sigma;
  made.poses.covariance.bottomRightCorner<3, 3>() =
      sensor.gyroscope_bias_sigma * sensor.gyroscope_bias_sigma * Matrix3d::Identity();
  return made;
}

AlignmentProblem simulated_problem(const SimulatedAlignment& made,
                                   const Vector3d& gyro_bias,
                                   const ImuNoise& noise) {
  const auto between =
      imu_intervals(made.gyroscope, made.poses.times_ns, 0, gyro_bias, noise).between;
  AlignmentProblem problem;
  problem.path = inertial_path(between, made.gyroscope.R_gyro_camera.transpose());
  problem.centers.resize(made.poses.center_rows());
  for (std::size_t k = 1; k < made.poses.cameras.size(); ++k)
    problem.centers.segment<3>(3 * (static_cast<Eigen::Index>(k) - 1)) = made.poses.cameras[k].p_wc;
  problem.covariance = made.poses.covariance;
  problem.inertial_noise = position_covariance(problem.path);
  problem.lever_m = made.T_body_camera.p_wc;
  problem.lever_sigma_m = 0.005;
  problem.bias_sigma_m_s2 = 0.1;
  return problem;
}

AlignmentState true_state(const SimulatedAlignment& made) {
  return {.velocity = made.velocities.front(),
          .gravity = made.gravity,
          .log_scale = std::log(made.scale),
          .bias = made.accelerometer_bias,
          .lever = made.T_body_camera.p_wc};
}

}  // namespace gpo
