// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/engine/calibration/plane/simulated_views.h"

#include <cmath>
#include <numbers>
#include <random>

namespace gpo {
namespace {

constexpr int kFramesAView = 4;

/// Smooth motion of a hand: harmonics of random amplitudes and phases, from -1 to 1.
class Wander {
 public:
  explicit Wander(std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int k = 0; k < 3; ++k) {
      amplitude_[k] = (0.4 + 0.6 * uniform(random)) / (k + 1.0);
      phase_[k] = 2 * std::numbers::pi * uniform(random);
      frequency_[k] = (k + 0.5 + uniform(random));
    }
  }
  double operator()(double t) const {
    double sum = 0;
    double all = 0;
    for (int k = 0; k < 3; ++k) {
      sum += amplitude_[k] * std::sin(2 * std::numbers::pi * frequency_[k] * t + phase_[k]);
      all += amplitude_[k];
    }
    return sum / all;
  }

 private:
  double amplitude_[3];
  double phase_[3];
  double frequency_[3];
};

/// Adds waves about as long as an image is wide.
void raise(Eigen::Matrix3Xd& points, double most_m, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0, 2 * std::numbers::pi);
  for (int wave = 0; wave < 4; ++wave) {
    const double heading = uniform(random);
    const double phase = uniform(random);
    const double rate = 4 + wave;  // [rad / m]
    const Eigen::Vector2d along = rate * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    for (auto point : points.colwise())
      point.z() += most_m / 4 * std::sin(along.dot(point.head<2>()) + phase);
  }
}

/// Motion of a hand-held camera over the plane; time from 0 to 1.
class Way {
 public:
  Way(const SimulatedViews& options, std::mt19937_64& random)
      : options_(options),
        slant_x_(random),
        slant_y_(random),
        roll_(random),
        x_(random),
        y_(random),
        z_(random) {}

  /// Looks along +z from z < 0, with the shared tilt and slants of its own.
  Pose pose_at(double t) const {
    const double slant = radians(options_.slant_deg);
    const Eigen::Matrix3d R_wc =
        so3_exp({radians(options_.kept_tilt_deg) + slant * slant_x_(t), slant * slant_y_(t), 0}) *
        so3_exp({0, 0, 0.4 * roll_(t)});
    const Eigen::Vector3d looked_at(options_.moves_m * x_(t), options_.moves_m * y_(t), 0);
    return {R_wc, looked_at - (1 + 0.3 * options_.moves_m * z_(t)) * R_wc.col(2)};
  }
  Eigen::Vector2d pixel_at(double t, const Eigen::Vector3d& point) const {
    return project(options_.camera, to_camera(pose_at(t), point));
  }
  /// Position at the time of its row, which depends on the position.
  Eigen::Vector2d read_at(double t, const Eigen::Vector3d& point) const {
    Eigen::Vector2d px = pixel_at(t, point);
    for (int pass = 0; options_.readout != 0 && pass < 3; ++pass) {
      const double later = options_.readout * ((px.y() + 0.5) / options_.camera.height - 0.5);
      px = pixel_at(t + later * frame_step(), point);
    }
    return px;
  }
  Eigen::Vector2d flow_at(double t, const Eigen::Vector3d& point) const {
    return 0.5 * (pixel_at(t + frame_step(), point) - pixel_at(t - frame_step(), point));
  }

 private:
  double frame_step() const { return 1.0 / (kFramesAView * options_.images); }

  const SimulatedViews& options_;
  Wander slant_x_, slant_y_, roll_, x_, y_, z_;
};

}  // namespace

SimulatedScene simulate_views(const SimulatedViews& options, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::normal_distribution<double> normal(0, 1);
  const Camera& camera = options.camera;
  Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Zero(3, options.points);
  Eigen::Matrix2Xd offsets(2, options.points);
  for (int j = 0; j < options.points; ++j) {
    points.col(j).head<2>() << options.half_m * uniform(random), options.half_m * uniform(random);
    offsets.col(j) << options.track_noise_px * normal(random),
        options.track_noise_px * normal(random);
  }
  if (options.unevenness_m > 0) raise(points, options.unevenness_m, random);
  const Way way(options, random);
  SimulatedScene scene;
  scene.plane.points = options.points;
  for (int i = 0; i < options.images; ++i) {
    const double t = static_cast<double>(i) / options.images;
    const Pose pose = way.pose_at(t);
    PlaneView view{kFramesAView * i, {}, {}};
    std::vector<Eigen::Vector2d> observed, flows;
    for (int j = 0; j < options.points; ++j) {
      if (to_camera(pose, points.col(j)).z() < 0.05) continue;
      Eigen::Vector2d px = way.read_at(t, points.col(j));
      if (!px.allFinite()) continue;
      px += offsets.col(j) + options.noise_px * Eigen::Vector2d(normal(random), normal(random));
      if (uniform(random) > 1 - 2 * options.outliers)
        px += 20 * Eigen::Vector2d(uniform(random), uniform(random));
      if (px.minCoeff() < 0 || px.x() > camera.width - 1 || px.y() > camera.height - 1) continue;
      view.points.push_back(j);
      observed.push_back(px);
      flows.push_back(way.flow_at(t, points.col(j)));
    }
    view.raw_px.resize(2, std::ssize(observed));
    view.flow_px.resize(2, std::ssize(observed));
    for (std::size_t k = 0; k < observed.size(); ++k) {
      view.raw_px.col(k) = observed[k];
      view.flow_px.col(k) = flows[k];
    }
    scene.plane.views.push_back(std::move(view));
    scene.poses.push_back(pose);
  }
  return scene;
}

}  // namespace gpo
