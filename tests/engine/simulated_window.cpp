// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/engine/simulated_window.h"

#include "engine/geometry/homography.h"
#include "engine/planes/inliers.h"
#include "engine/rotations/rotations.h"
#include "engine/window/gyroscope.h"
#include "engine/window/tracks.h"

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo::test {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

/// Draws the last one first, as one compiler evaluates arguments; compilers differ in that order.
template <int count>
Eigen::Vector<double, count> drawn(auto& distribution, std::mt19937_64& random) {
  Eigen::Vector<double, count> numbers;
  for (int k = count - 1; k >= 0; --k) numbers[k] = distribution(random);
  return numbers;
}

Vector3d position(const SimulationOptions& options, const Vector3d& normal, double s) {
  const double angle = s * std::numbers::pi / 2;
  switch (options.motion) {
    case Motion::sideways:
      return options.travel * s * Vector3d::UnitX();
    case Motion::orbit:
      return options.travel *
             Vector3d(std::sin(angle), 0.4 * (1 - std::cos(angle)), 0.5 * (1 - std::cos(angle)));
    case Motion::forward:
      return options.travel * s * Vector3d::UnitZ();
    case Motion::approach:
      return -options.travel * s * normal;
    case Motion::oblique:
      return -options.travel * s * (normal + 0.6 * normal.unitOrthogonal()).normalized();
    case Motion::up_down:
      return options.travel * std::sin(2 * angle) * Vector3d::UnitY();
    case Motion::arc:
      return options.travel *
             Vector3d(std::sin(angle), 1 - std::cos(angle), 0.2 * std::sin(2 * angle));
    case Motion::wander:
      return options.travel *
             Vector3d(0.5 * std::sin(4 * s), 0.4 * std::sin(3 * s), 0.3 * std::sin(5 * s));
    case Motion::rotation_only:
      break;
  }
  return Vector3d::Zero();
}

constexpr double kFramePeriod_s = 1.0 / 30;
constexpr std::int64_t kFirst_ns = 1'000'000'000;
constexpr double kMiddleRow = 239.5;

Matrix3d rotation(const Vector3d& wobble_rad, double s) {
  return so3_exp(
      wobble_rad.cwiseProduct(Vector3d(std::sin(3 * s), std::sin(2 * s), std::sin(4 * s))));
}

/// Returns a rotated gyroscope of 200 Hz that measures the true rotation with noise and bias.
Gyroscope gyroscope_of(const SimulationOptions& options,
                       const Vector3d& wobble_rad,
                       const Vector3d& bias_rad_s) {
  std::mt19937_64 random(options.seed + 1'000'003);
  std::normal_distribution<double> normal_noise;
  Gyroscope gyroscope;
  gyroscope.bias_sigma_rad_s = 0.01;
  gyroscope.noise_density = options.gyro_noise_rad_s * std::sqrt(0.005);
  gyroscope.R_gyro_camera = so3_exp(Vector3d(1.2, -0.7, 2));
  gyroscope.time_offset_ns = std::llround(1e9 * options.recorded_offset_s);
  const double last_s = kFramePeriod_s * (options.frames - 1);
  constexpr double kPeriod_s = 0.005;
  constexpr double kMargin_s = 0.03;
  for (double t = -kMargin_s; t < last_s + kMargin_s; t += kPeriod_s) {
    const auto at = [&](double seconds) { return rotation(wobble_rad, seconds / last_s); };
    const Vector3d rate_c =
        so3_log(at(t - kPeriod_s / 2).transpose() * at(t + kPeriod_s / 2)) / kPeriod_s;
    const Vector3d noise = drawn<3>(normal_noise, random);
    gyroscope.timestamps_ns.push_back(kFirst_ns + std::llround(1e9 * (t + options.gyro_offset_s)));
    gyroscope.rates_rad_s.emplace_back(gyroscope.R_gyro_camera * rate_c + bias_rad_s +
                                       options.gyro_noise_rad_s * noise);
    gyroscope.lines.push_back(static_cast<int>(gyroscope.lines.size()) + 2);
  }
  return gyroscope;
}

Vector3d bias_of(const SimulationOptions& options) {
  std::mt19937_64 random(options.seed + 2'000'003);
  std::normal_distribution<double> normal_noise;
  return *options.gyro_bias_rad_s * drawn<3>(normal_noise, random).normalized();
}

/// Returns the amplitude of the camera's rotations, drawn after the plane.
Vector3d wobble_of(std::normal_distribution<double>& normal_noise, std::mt19937_64& random) {
  return 0.1 * drawn<3>(normal_noise, random);
}

/// Replaces the true rotations by those of the gyroscope.
void give_gyroscope(const SimulationOptions& options,
                    const Vector3d& wobble_rad,
                    Simulation& simulation) {
  simulation.bias_rad_s = bias_of(options);
  simulation.time_offset_s = options.gyro_offset_s;
  Window& window = simulation.window;
  Rotations rotations = sensitive_gyro_rotations(
      gyroscope_of(options, wobble_rad, simulation.bias_rad_s), window.timestamps_ns);
  window.R_wc = rotations.R_wc;
  window.rotations = rotations.model;
  window.gyro = rotations.gyro;
}

/// Returns the camera at a share of the path.
Pose camera_at(const SimulationOptions& options,
               const Vector3d& wobble_rad,
               const Vector3d& normal,
               double s) {
  return {rotation(wobble_rad, s), position(options, normal, s)};
}

/// Returns the pixel of a point in a frame, at the time when its row is exposed.
Eigen::Vector2d seen_px(const SimulationOptions& options,
                        const Simulation& simulation,
                        const Vector3d& wobble_rad,
                        const Vector3d& point,
                        int frame) {
  const Eigen::Matrix3d& K = simulation.window.K;
  Eigen::Vector2d pixel = (K * to_camera(simulation.cameras[frame], point)).hnormalized();
  const double duration_s = kFramePeriod_s * std::max(1, options.frames - 1);
  for (int round = 0; options.row_delay_s != 0 && round < 10; ++round) {
    const double row = options.lens ? distort(*options.lens, pixel).y() : pixel.y();
    const double seconds = kFramePeriod_s * frame + options.row_delay_s * (row - kMiddleRow);
    const Pose camera =
        camera_at(options, wobble_rad, simulation.plane.normal, seconds / duration_s);
    pixel = (K * to_camera(camera, point)).hnormalized();
  }
  return pixel;
}

}  // namespace

Simulation simulate(const SimulationOptions& options) {
  std::mt19937_64 random(options.seed);
  std::normal_distribution<double> normal_noise;
  std::uniform_real_distribution<double> uniform(0, 1);
  Simulation simulation;
  Window& window = simulation.window;
  window.K << 500, 0, 319.5, 0, 500, kMiddleRow, 0, 0, 1;
  const Matrix3d K_inverse = window.K.inverse();
  const double azimuth = 2 * std::numbers::pi * uniform(random);
  const double tilt = radians(options.tilt_deg);
  simulation.plane = {
      Vector3d(
          std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), -std::cos(tilt)),
      1};
  const Vector3d wobble = wobble_of(normal_noise, random);
  for (int i = 0; i < options.frames; ++i) {
    const double s = static_cast<double>(i) / std::max(1, options.frames - 1);
    simulation.cameras.push_back(camera_at(options, wobble, simulation.plane.normal, s));
  }
  window.points_px.assign(options.frames, Eigen::Matrix2Xd(2, options.points));
  for (int j = 0; j < options.points; ++j) {
    std::optional<Vector3d> point;
    while (!point || point->norm() > 4) {
      const Eigen::Vector2d px = Eigen::Vector2d(30, 30) +
                                 Eigen::Vector2d(580, 420).cwiseProduct(drawn<2>(uniform, random));
      point = intersect(simulation.plane, Pose{}, K_inverse * px.homogeneous());
    }
    const bool on_plane = j >= options.off_plane * options.points;
    if (!on_plane) *point *= 0.6 + 0.3 * uniform(random);  // an object on the plane
    simulation.on_plane.push_back(on_plane);
    for (int i = 0; i < options.frames; ++i) {
      const Eigen::Vector2d exact = seen_px(options, simulation, wobble, *point, i);
      const double sigma = i == 0 ? options.reference_noise_px : options.noise_px;
      window.points_px[i].col(j) = exact + sigma * drawn<2>(normal_noise, random);
    }
  }
  window.exact_reference = options.reference_noise_px == 0;
  for (int i = 0; i < options.frames; ++i) {
    const auto& [R, p] = simulation.cameras[i];
    const Matrix3d I = Matrix3d::Identity();
    window.timestamps_ns.push_back(kFirst_ns + std::llround(1e9 * kFramePeriod_s * i));
    window.inlier.push_back(simulation.on_plane);
    window.R_wc.push_back(R);
    window.H_i1.push_back(window.K * R.transpose() * (I + p * simulation.plane.normal.transpose()) *
                          K_inverse);
  }
  if (options.gyro_bias_rad_s) give_gyroscope(options, wobble, simulation);
  return simulation;
}

SimulationOptions noisy(Motion motion, std::uint64_t seed, double noise_px) {
  SimulationOptions options;
  options.motion = motion;
  options.noise_px = options.reference_noise_px = noise_px;
  options.seed = seed;
  return options;
}

PlaneMotion true_motion(const Simulation& simulation) {
  return motion_of(simulation.plane, simulation.cameras);
}

Gyroscope simulated_gyroscope(const SimulationOptions& options) {
  std::mt19937_64 random(options.seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  uniform(random);  // the plane's azimuth
  std::normal_distribution<double> normal_noise;
  return gyroscope_of(options, wobble_of(normal_noise, random), bias_of(options));
}

Simulation with_fitted_homographies(Simulation simulation) {
  Window& window = simulation.window;
  for (int i = 1; i < window.frame_count(); ++i) {
    std::vector<int> inliers;
    for (int j = 0; j < window.track_count(); ++j)
      if (window.inlier[i][j]) inliers.push_back(j);
    const Eigen::Matrix2Xd from = window.points_px[0](Eigen::all, inliers);
    const Eigen::Matrix2Xd to = window.points_px[i](Eigen::all, inliers);
    window.H_i1[i] = refine_homography(*fit_homography(from, to), from, to);
  }
  return simulation;
}

Simulation turned(Simulation simulation, int quarter_turns) {
  Window& window = simulation.window;
  const Matrix3d M = so3_exp({0, 0, std::numbers::pi / 2});
  for (int turn = 0; turn < quarter_turns; ++turn) {
    const Matrix3d K = window.K;
    const double last_row = 2 * K(1, 2);
    Matrix3d T;
    T << 0, -1, last_row, 1, 0, 0, 0, 0, 1;
    window.K << K(1, 1), 0, last_row - K(1, 2), 0, K(0, 0), K(0, 2), 0, 0, 1;
    window.readout_direction = T.topLeftCorner<2, 2>() * window.readout_direction;
    simulation.plane.normal = M * simulation.plane.normal;
    for (int i = 0; i < window.frame_count(); ++i) {
      window.points_px[i] = (T * window.points_px[i].colwise().homogeneous()).topRows<2>().eval();
      window.H_i1[i] = T * window.H_i1[i] * T.inverse();
      window.R_wc[i] = M * window.R_wc[i] * M.transpose();
      Pose& camera = simulation.cameras[i];
      camera = {M * camera.R_wc * M.transpose(), M * camera.p_wc};
    }
  }
  return simulation;
}

Window window_by_front_end(const Simulation& simulation, Inliers inliers) {
  const Camera camera{640, 480, 500, 500, 319.5, 239.5, Distortion::none, {}};
  Tracks tracks{0, std::vector<std::int64_t>(simulation.window.track_count()), {}};
  std::iota(tracks.ids.begin(), tracks.ids.end(), 0);
  tracks.raw_px = simulation.window.points_px;
  tracks.anchored = simulation.window.exact_reference;
  Window window =
      make_window(tracks, camera, simulation.window.timestamps_ns, {.inliers = inliers});
  window.R_wc = simulation.window.R_wc;
  return window;
}

}  // namespace gpo::test
