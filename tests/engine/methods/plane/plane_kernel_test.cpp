// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/plane_kernel.h"

#include "engine/base/processor.h"
#include "engine/geometry/pose.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/plane_weights.h"
#include "tests/engine/simulated_window.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using Eigen::Vector3d;
using Vector8d = Eigen::Matrix<double, 8, 1>;

/// A frame away from its minimum, where all terms are large.
struct Disturbed {
  Window window;
  PlaneObservations observations;
  PlaneMotion motion;
  int frame;

  explicit Disturbed(std::uint64_t seed, int points = 37)
      : window(simulate({.motion = Motion::wander, .frames = 9, .points = points, .seed = seed})
                   .window),
        observations(plane_observations(window)),
        frame(6) {
    const Simulation truth =
        simulate({.motion = Motion::wander, .frames = 9, .points = points, .seed = seed});
    motion = motion_of(truth.plane, truth.cameras);
    motion.normal = moved_normal(motion.normal, {0.05, -0.03});
    motion.tau[frame] += Vector3d(0.01, 0.02, -0.03);
    motion.R_wc[frame] *= so3_exp({0.01, -0.02, 0.015});
  }

  FrameState state() const { return frame_state(observations, motion, frame); }

  /// Returns half the summed squares after a step over (u, phi, t), computed differently.
  double cost_after(const Vector8d& step) const {
    PlaneMotion moved = motion;
    moved.normal = moved_normal(motion.normal, step.head<2>());
    moved.R_wc[frame] *= so3_exp(step.segment<3>(2));
    moved.tau[frame] += motion.R_wc[frame] * step.tail<3>();
    const FrameState after = frame_state(observations, moved, frame);
    double cost = 0;
    for (int k = 0; k < observations.frames[frame].count; ++k)
      cost += 0.5 * transfer_error_px(observations.frames[frame], after, k).squaredNorm();
    return cost;
  }
};

/// Returns the normal equations from `transfer_on_plane`, which has its own test.
FrameNormals by_transfer(const Disturbed& d, Rotating rotating) {
  FrameNormals sum;
  const FrameObservations& f = d.observations.frames[d.frame];
  const FrameState state = d.state();
  for (int k = 0; k < f.count; ++k) {
    Eigen::Matrix<double, 2, 8> J = transfer_of(f, state, k).jacobian(state.tangents);
    if (rotating == Rotating::no) J.middleCols<3>(2).setZero();
    const Eigen::Vector2d r = transfer_error_px(f, state, k);
    sum.JtJ += J.transpose() * J;
    sum.Jtr += J.transpose() * r;
    sum.cost += 0.5 * r.squaredNorm();
  }
  return sum;
}

void expect_equal(const FrameNormals& a, const FrameNormals& b) {
  EXPECT_TRUE(a.in_front);
  EXPECT_LT((a.JtJ - b.JtJ).norm(), 1e-11 * b.JtJ.norm());
  EXPECT_LT((a.Jtr - b.Jtr).norm(), 1e-11 * b.Jtr.norm());
  EXPECT_NEAR(a.cost, b.cost, 1e-11 * b.cost);
}

TEST(PlaneKernel, AllVersionsSumJacobiansOfTransfer) {
  for (const int points : {8, 9, 10, 11, 150}) {
    for (const Rotating rotating : {Rotating::no, Rotating::yes}) {
      const Disturbed d(points, points);
      const auto& observations = d.observations.frames[d.frame];
      const FrameNormals expected = by_transfer(d, rotating);
      expect_equal(frame_normals_baseline(observations, d.state(), rotating), expected);
      expect_equal(frame_normals(observations, d.state(), rotating), expected);
      if (has_avx2_fma())
        expect_equal(frame_normals_avx2_fma(observations, d.state(), rotating), expected);
    }
  }
}

TEST(PlaneKernel, GradientMatchesCost) {
  const Disturbed d(3);
  const FrameNormals normals =
      frame_normals(d.observations.frames[d.frame], d.state(), Rotating::yes);
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 8; ++k) {
    const Vector8d step = kStep * Vector8d::Unit(k);
    const double slope = (d.cost_after(step) - d.cost_after(-step)) / (2 * kStep);
    EXPECT_NEAR(normals.Jtr(k), slope, 1e-5 * normals.Jtr.norm()) << k;
  }
}

TEST(PlaneKernel, MatchesUnitWeightMatrices) {
  const Disturbed d(4);
  FrameObservations weighted = d.observations.frames[d.frame];
  weighted.weight.assign(weighted.count, Eigen::Matrix2d::Identity());
  expect_equal(frame_normals(d.observations.frames[d.frame], d.state(), Rotating::yes),
               weighted_normals(weighted, d.state(), Rotating::yes));
}

TEST(PlaneKernel, DetectsPointBehindCamera) {
  Disturbed d(5);
  EXPECT_TRUE(frame_normals(d.observations.frames[d.frame], d.state(), Rotating::no).in_front);
  d.motion.R_wc[d.frame] *= so3_exp({0, 2.5, 0});
  EXPECT_FALSE(frame_normals(d.observations.frames[d.frame], d.state(), Rotating::no).in_front);
}

TEST(GyroColumns, MatchFiniteDifferences) {
  const Simulation truth = simulate({.motion = Motion::wander, .gyro_bias_rad_s = 0.01, .seed = 4});
  const int frame = 17;
  PlaneMotion motion = motion_without_translation(truth.window);
  motion.bias_rad_s += Vector3d(0.3, -0.2, 0.1);
  motion.time_offset_s = 0.1;
  motion.gyro_noise_rad.assign(truth.window.frame_count(), Vector3d(0.2, -0.3, 0.1));
  const GyroColumns columns = gyro_columns(truth.window, motion, frame, 4);
  const auto rotation = [&](int unknown, double step) {
    PlaneMotion moved = motion;
    (unknown == 3 ? moved.time_offset_s : moved.bias_rad_s[unknown]) += step;
    return gyro_rotation(truth.window, frame, moved);
  };
  constexpr double kStep = 1e-5;
  for (int k = 0; k < 4; ++k) {
    const Vector3d numeric =
        so3_log(rotation(k, -kStep).transpose() * rotation(k, kStep)) / (2 * kStep);
    EXPECT_LT((columns.col(k) - numeric).norm(), 1e-7) << k;
  }
}

TEST(GyroNoise, GrowsWithRootOfTime) {
  Simulation truth = simulate({.frames = 17, .gyro_bias_rad_s = 0});
  truth.window.gyro->noise_density = 1e-3;
  EXPECT_EQ(gyro_noise_sigma_rad(truth.window, 0), 0);
  EXPECT_NEAR(gyro_noise_sigma_rad(truth.window, 4), 1e-3 * std::sqrt(4 / 30.0), 1e-9);
  EXPECT_NEAR(gyro_noise_sigma_rad(truth.window, 16), 2e-3 * std::sqrt(4 / 30.0), 1e-9);
}

}  // namespace
}  // namespace gpo::test
