// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/window/gyroscope.h"
#include "engine/window/window.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace gpo::test {

/// forward: along the optical axis. approach: along the plane's normal, where rotations of camera
/// and normal look alike. wander: hand-held. arc: fast, sideways on a curve that rotates with the
/// camera. oblique: towards the plane at 31 deg to its normal, along a straight line; both
/// decompositions of its homographies have points in front of the camera.
enum class Motion {
  sideways,
  orbit,
  forward,
  approach,
  oblique,
  up_down,
  wander,
  arc,
  rotation_only
};

/// All that translate the camera.
inline constexpr Motion kMotions[] = {Motion::sideways,
                                      Motion::orbit,
                                      Motion::forward,
                                      Motion::approach,
                                      Motion::oblique,
                                      Motion::up_down,
                                      Motion::wander,
                                      Motion::arc};

struct SimulationOptions {
  Motion motion = Motion::sideways;
  int frames = 30;
  int points = 150;
  double noise_px = 0.5;  ///< on each coordinate, in all frames but the reference frame
  double travel = 0.3;    ///< length of the path [plane distance]
  double tilt_deg = 40;   ///< angle between the optical axis and the plane's normal
  double off_plane = 0;   ///< share of the tracks off the plane
  /// Length of the unknown bias, in a random direction, of the gyroscope from which rotations are
  /// integrated [rad/s]; nullopt: the true rotations.
  std::optional<double> gyro_bias_rad_s = std::nullopt;
  double gyro_offset_s = 0;       ///< gyroscope clock = camera clock + offset, also unknown
  double recorded_offset_s = 0;   ///< the same according to the recording
  double reference_noise_px = 0;  ///< on each coordinate, in the reference frame
  double row_delay_s = 0;         ///< rolling shutter, around the middle row
  /// Camera of the recorded image, whose rows are read; nullopt: no distortion.
  std::optional<Camera> lens = std::nullopt;
  double gyro_noise_rad_s = 0;  ///< per sample and axis, at 200 Hz; a phone's is about 0.002
  std::uint64_t seed = 1;
};

/// A window with its exact solution in the gauge of an initialization: world = reference camera, d
/// = 1. 640x480, f = 500 px. Tracks on the plane are marked as inliers; rotations are the true
/// ones.
struct Simulation {
  Window window;
  Plane plane;
  std::vector<Pose> cameras;
  std::vector<bool> on_plane;
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();  ///< true, in the gyroscope's axes
  double time_offset_s = 0;                              ///< true, of the gyroscope's clock
};

Simulation simulate(const SimulationOptions& options);

/// Returns options of tracks with the same noise in all frames.
SimulationOptions noisy(Motion motion, std::uint64_t seed, double noise_px = 0.5);

PlaneMotion true_motion(const Simulation& simulation);

/// Returns the samples of the gyroscope with the options' bias, noise and clock.
Gyroscope simulated_gyroscope(const SimulationOptions& options);

/// Replaces the exact homographies by those fitted to the noisy inliers, as in a recording.
Simulation with_fitted_homographies(Simulation simulation);
inline Simulation simulate_fitted(const SimulationOptions& options) {
  return with_fitted_homographies(simulate(options));
}

/// Returns the same with images rotated clockwise, without a gyroscope.
Simulation turned(Simulation simulation, int quarter_turns);

/// Returns the window of the same tracks with the front end's inliers; rotations are the true ones.
Window window_by_front_end(const Simulation& simulation, Inliers inliers);

}  // namespace gpo::test
