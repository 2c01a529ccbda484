// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/rotations.h"

#include "engine/base/error.h"
#include "engine/geometry/pose.h"
#include "engine/window/gyroscope.h"
#include "engine/window/window.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using ::testing::HasSubstr;

/// 200 Hz over two seconds, from a rotation known in closed form.
Gyroscope constant_rate(const Vector3d& rate) {
  Gyroscope gyroscope;
  gyroscope.file = "imu0/data.csv";
  for (int k = 0; k < 400; ++k) {
    gyroscope.timestamps_ns.push_back(1'000'000'000 + 5'000'000LL * k);
    gyroscope.lines.push_back(k + 2);
    gyroscope.rates_rad_s.push_back(rate);
  }
  return gyroscope;
}

std::vector<std::int64_t> frame_times() {
  std::vector<std::int64_t> times;
  times.reserve(30);
  for (int i = 0; i < 30; ++i) times.push_back(1'101'234'567 + 33'333'333LL * i);
  return times;
}

std::string message(const Gyroscope& gyroscope, const std::vector<std::int64_t>& times) {
  try {
    gyro_rotations(gyroscope, times);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(GyroRotations, ConstantRateHasAClosedForm) {
  const Vector3d rate(0.3, -0.5, 0.8);
  const auto times = frame_times();
  const auto R = gyro_rotations(constant_rate(rate), times);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double seconds = static_cast<double>(times[i] - times[0]) * 1e-9;
    EXPECT_LT((R[i] - so3_exp(rate * seconds)).norm(), 1e-12);
  }
}

TEST(GyroRotations, VaryingRateAboutOneAxisIsItsIntegral) {
  Gyroscope gyroscope = constant_rate(Vector3d::Zero());
  for (std::size_t k = 0; k < 400; ++k)
    gyroscope.rates_rad_s[k].z() = 1.5 * static_cast<double>(k) * 0.005;
  const auto times = frame_times();
  const auto R = gyro_rotations(gyroscope, times);
  const auto angle = [](std::int64_t t) {
    return 0.75 * std::pow(static_cast<double>(t - 1'000'000'000) * 1e-9, 2);
  };
  EXPECT_LT((R[29] - so3_exp({0, 0, angle(times[29]) - angle(times[0])})).norm(), 1e-9);
}

TEST(GyroRotations, BiasAndExtrinsicsAndClockOffsetAreApplied) {
  const Vector3d rate(0.3, -0.5, 0.8);
  Gyroscope gyroscope = constant_rate(rate);
  gyroscope.bias_rad_s = Vector3d(0.01, 0.02, -0.03);
  gyroscope.R_gyro_camera = so3_exp({1, -2, 0.5});
  const auto times = frame_times();
  const double seconds = static_cast<double>(times[29] - times[0]) * 1e-9;
  const Vector3d in_camera = gyroscope.R_gyro_camera.transpose() * (rate - gyroscope.bias_rad_s);
  EXPECT_LT((gyro_rotations(gyroscope, times)[29] - so3_exp(in_camera * seconds)).norm(), 1e-12);

  Gyroscope late = gyroscope;  // the same samples on a clock that runs ahead by 20 ms
  for (auto& t : late.timestamps_ns) t += 20'000'000;
  late.time_offset_ns = 20'000'000;
  EXPECT_LT((gyro_rotations(late, times)[29] - gyro_rotations(gyroscope, times)[29]).norm(), 1e-12);
}

/// Rates that wander by some rad/s, at times that jitter by a fifth of a period, with axes, a bias
/// and a clock of their own.
Gyroscope wandering_rate(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> jitter_ns(-1e6, 1e6);
  std::normal_distribution<double> normal;
  const auto vector = [&]() { return Vector3d(normal(random), normal(random), normal(random)); };
  Gyroscope gyroscope = constant_rate(vector());
  const Vector3d swing = 2 * vector();
  const Vector3d phase = vector();
  for (std::size_t k = 0; k < gyroscope.rates_rad_s.size(); ++k) {
    gyroscope.timestamps_ns[k] += static_cast<std::int64_t>(jitter_ns(random));
    const double t = static_cast<double>(gyroscope.timestamps_ns[k] - 1'000'000'000) * 1e-9;
    for (int axis = 0; axis < 3; ++axis)
      gyroscope.rates_rad_s[k][axis] += swing[axis] * std::sin(5 * t + phase[axis]);
  }
  gyroscope.bias_rad_s = 0.05 * vector();
  gyroscope.R_gyro_camera = so3_exp(vector());
  gyroscope.time_offset_ns = 3'456'789;
  return gyroscope;
}

/// Of R_wc by right perturbation, from the rotations a step before and a step after.
Vector3d slope(const Matrix3d& before, const Matrix3d& after, double step) {
  return so3_log(before.transpose() * after) / (2 * step);
}

TEST(GyroSensitivity, OfTheBiasIsTheDifferenceQuotient) {
  constexpr double kStep_rad_s = 1e-5;
  const auto times = frame_times();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Gyroscope gyroscope = wandering_rate(seed);
    const Rotations rotations = sensitive_gyro_rotations(gyroscope, times);
    for (int axis = 0; axis < 3; ++axis) {
      Gyroscope before = gyroscope;
      Gyroscope after = gyroscope;
      before.bias_rad_s[axis] -= kStep_rad_s;
      after.bias_rad_s[axis] += kStep_rad_s;
      const auto R_before = gyro_rotations(before, times);
      const auto R_after = gyro_rotations(after, times);
      for (std::size_t i = 0; i < times.size(); ++i) {
        const Vector3d expected = slope(R_before[i], R_after[i], kStep_rad_s);
        EXPECT_LT((rotations.gyro->d_bias[i].col(axis) - expected).norm(), 1e-8)
            << "seed " << seed << " frame " << i;
      }
    }
  }
}

// To the order of the samples' own linear interpolation: 0.1 % of the rates, which reach 5 rad/s.
TEST(GyroSensitivity, OfTheClockIsTheDifferenceQuotient) {
  constexpr std::int64_t kStep_ns = 20'000;
  const auto times = frame_times();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Gyroscope gyroscope = wandering_rate(seed);
    const Rotations rotations = sensitive_gyro_rotations(gyroscope, times);
    Gyroscope before = gyroscope;
    Gyroscope after = gyroscope;
    before.time_offset_ns -= kStep_ns;
    after.time_offset_ns += kStep_ns;
    const auto R_before = gyro_rotations(before, times);
    const auto R_after = gyro_rotations(after, times);
    for (std::size_t i = 0; i < times.size(); ++i) {
      const Vector3d expected =
          slope(R_before[i], R_after[i], static_cast<double>(kStep_ns) * 1e-9);
      EXPECT_LT((rotations.gyro->d_offset[i] - expected).norm(), 5e-3)
          << "seed " << seed << " frame " << i << " " << expected.transpose();
    }
  }
}

TEST(GyroSensitivity, KnowsTheBiasItsPriorAndTheNoise) {
  Gyroscope gyroscope = constant_rate(Vector3d(0.1, 0.2, 0.3));
  gyroscope.bias_rad_s = Vector3d(0.01, 0.02, -0.03);
  gyroscope.bias_sigma_rad_s = 0.002;
  gyroscope.noise_density = 0.0007;
  const Rotations rotations = sensitive_gyro_rotations(gyroscope, frame_times());
  EXPECT_EQ(rotations.model, RotationModel::bias);
  EXPECT_EQ(rotations.gyro->bias_rad_s, gyroscope.bias_rad_s);
  EXPECT_EQ(rotations.gyro->prior_rad_s, gyroscope.bias_rad_s);
  EXPECT_EQ(rotations.gyro->prior_sigma_rad_s, 0.002);
  EXPECT_EQ(rotations.gyro->noise_density, 0.0007);
  EXPECT_EQ(rotations.gyro->d_bias.size(), 30U);
  EXPECT_EQ(rotations.gyro->d_offset.size(), 30U);
}

TEST(GyroRotations, SayWhereAGapIs) {
  Gyroscope gyroscope = constant_rate(Vector3d::Zero());
  const auto cut = [](auto& values) { values.erase(values.begin() + 100, values.begin() + 120); };
  cut(gyroscope.timestamps_ns);
  cut(gyroscope.lines);
  cut(gyroscope.rates_rad_s);
  EXPECT_THAT(message(gyroscope, frame_times()), HasSubstr("imu0/data.csv:122: gap of 0.105 s"));
  // A gap outside of the window does no harm.
  EXPECT_EQ(message(gyroscope, {1'650'000'000, 1'700'000'000}), "");
}

TEST(GyroRotations, SayWhereSamplesAreOutOfOrder) {
  Gyroscope gyroscope = constant_rate(Vector3d::Zero());
  std::swap(gyroscope.timestamps_ns[100], gyroscope.timestamps_ns[101]);
  EXPECT_THAT(message(gyroscope, frame_times()), HasSubstr("imu0/data.csv:103: time stamp"));
}

TEST(GyroRotations, SayThatTheWindowIsNotCovered) {
  EXPECT_THAT(message(constant_rate(Vector3d::Zero()), {900'000'000, 1'100'000'000}),
              HasSubstr("0.100 s after the window's first frame"));
  EXPECT_THAT(message(constant_rate(Vector3d::Zero()), {1'100'000'000, 3'100'000'000}),
              HasSubstr("0.105 s before the window's last frame"));
}

TEST(RotationSource, TypoNamesTheKnownOnes) {
  try {
    choice<RotationSource>("gyr");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "rotations: unknown value 'gyr', expected one of automatic, raw, gyro, "
                 "gyro-calibrated, averaging, five-point, direct, truth");
  }
}

}  // namespace
}  // namespace gpo
