// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/rotations.h"

#include "engine/error.h"

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
    rotation_source("gyr");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "--rotations: unknown source 'gyr', expected one of automatic, gyro, "
                 "gyro-calibrated, averaging, truth");
  }
}

}  // namespace
}  // namespace gpo
