// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/diagnosis/diagnosis.h"
#include "engine/methods/common/initialization.h"
#include "engine/methods/common/method_options.h"
#include "engine/window/window.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <stop_token>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace gpo::test {

inline constexpr Motion kUsualMotions[] = {
    Motion::sideways, Motion::orbit, Motion::approach, Motion::wander};

/// All motions except that along the normal, where a constant rotation is equivalent to a rotation
/// of the normal.
inline constexpr Motion kObservableMotions[] = {Motion::sideways,
                                                Motion::orbit,
                                                Motion::forward,
                                                Motion::oblique,
                                                Motion::up_down,
                                                Motion::wander,
                                                Motion::arc};

struct Perturbation {
  double rotation_deg = 0.5;  ///< standard deviation about each axis
  double position = 0.01;     ///< standard deviation of each coordinate [plane distance]
  double normal_deg = 2;      ///< tilt of the plane
  std::uint64_t seed = 1;
};

/// Returns the true poses and plane, perturbed except for the reference camera.
inline Initialization perturbed_truth(const Simulation& truth, const Perturbation& by = {}) {
  std::mt19937_64 random(by.seed);
  std::normal_distribution<double> gaussian;
  const auto vector = [&]() {
    return Eigen::Vector3d(gaussian(random), gaussian(random), gaussian(random));
  };
  Initialization start;
  start.ok = true;
  const Eigen::Vector3d axis = truth.plane.normal.cross(vector()).normalized();
  start.plane = {so3_exp(radians(by.normal_deg) * axis) * truth.plane.normal, 1};
  start.cameras = truth.cameras;
  for (std::size_t i = 1; i < start.cameras.size(); ++i) {
    Pose& camera = start.cameras[i];
    camera.R_wc = camera.R_wc * so3_exp(radians(by.rotation_deg) * vector());
    camera.p_wc += by.position * vector();
  }
  return start;
}

/// Returns a result that is ok. Throws the reason otherwise, which fails the test.
inline Initialization successful(Initialization result) {
  if (!result.ok) throw std::runtime_error(result.reason);
  return result;
}

/// Returns the result of a method with its uncertainty by regions, not judged.
inline Initialization uncertain_by(const char* key,
                                   const Window& window,
                                   const MethodOptions& options = {}) {
  const Method& method = find_method(key);
  const auto run = [&](const Window& w) { return method.initialize(w, options, {}); };
  Initialization result = run(window);
  result.own_noise = own_noise(method, window, result, run, options, {});
  return result.ok ? with_uncertainty(method, window, std::move(result)) : result;
}

/// Returns the same, judged.
inline Initialization resampled_by(const char* key,
                                   const Window& window,
                                   const MethodOptions& options = {}) {
  return assessed(find_method(key), window, uncertain_by(key, window, options));
}

inline double normal_error_deg(const Initialization& result, const Simulation& truth) {
  return angle_deg(result.plane.normal, truth.plane.normal);
}

/// Removes all observations of the tracks from `first_track` to before `end_track` in the frames
/// from 10 on.
inline void hide_tracks(Window& window, int first_track, int end_track) {
  for (int i = 10; i < window.frame_count(); ++i)
    for (int j = first_track; j < end_track; ++j) {
      window.points_px[i].col(j).setConstant(std::nan(""));
      window.inlier[i][j] = false;
    }
}

inline Window with_reversed_tracks(Window window) {
  for (auto& points : window.points_px) points = points.rowwise().reverse().eval();
  for (auto& inlier : window.inlier) std::reverse(inlier.begin(), inlier.end());
  return window;
}

inline std::stop_token stopped() {
  std::stop_source source;
  source.request_stop();
  return source.get_token();
}

inline void expect_exact_cameras(const Initialization& result, const Simulation& truth) {
  for (int i = 0; i < truth.window.frame_count(); ++i) {
    EXPECT_LT((result.cameras[i].p_wc - truth.cameras[i].p_wc).norm(), 1e-7) << "frame " << i;
    EXPECT_LT((result.cameras[i].R_wc - truth.cameras[i].R_wc).norm(), 1e-7) << "frame " << i;
  }
}

}  // namespace gpo::test
