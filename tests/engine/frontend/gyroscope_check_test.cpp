// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/gyroscope_alignment.h"
#include "engine/geometry/pose.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d, testing::StartsWith;

Vector3d camera_rate_at(double t_s) {
  return {0.5 * std::sin(5.1 * t_s) + 0.2 * std::cos(13 * t_s),
          0.6 * std::cos(3.7 * t_s + 1) + 0.1 * std::sin(17 * t_s),
          0.4 * std::sin(4.3 * t_s + 2)};
}

std::int64_t to_ns(double seconds) { return std::llround(1e9 * seconds); }

/// 30 frames at 30 Hz whose rates are `share` of the true ones, with 0.02 deg of noise each.
ImageRotations images(double share = 1) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> gauss(0, radians(0.02));
  ImageRotations window;
  Matrix3d R = Matrix3d::Identity();
  for (int i = 0; i < 30; ++i) {
    window.timestamps_ns.push_back(to_ns(i / 30.0));
    window.R_wc.emplace_back(R * so3_exp({gauss(random), gauss(random), gauss(random)}));
    for (int k = 0; k < 100; ++k)
      R = R * so3_exp(share * camera_rate_at((i + (k + 0.5) / 100) / 30) / 3000);
  }
  return window;
}

Gyroscope gyroscope(double late_s, const Matrix3d& R_gyro_camera) {
  Gyroscope made;
  for (double t = -0.5; t < 1.5; t += 0.005) {
    made.timestamps_ns.push_back(to_ns(t));
    made.rates_rad_s.emplace_back(R_gyro_camera * camera_rate_at(t - late_s) +
                                  Vector3d(0.01, -0.02, 0.03));
  }
  return made;
}

constexpr double kSigma_rad = 1e-4;  // error of the images' rotations

GyroscopeCheck check(const ImageRotations& window, const Gyroscope& gyroscope) {
  return check_gyroscope_against(window, gyroscope, kSigma_rad);
}

Gyroscope with_rates(double share) {
  Gyroscope made = gyroscope(0, Matrix3d::Identity());
  for (Vector3d& rate : made.rates_rad_s) rate *= share;
  return made;
}

TEST(RateIntegral, CoversTheFirstAndTheLastSample) {
  Gyroscope gyroscope;
  for (const int k : {0, 1, 2, 3}) {
    gyroscope.timestamps_ns.push_back(10'000'000 * k);
    gyroscope.rates_rad_s.emplace_back(k, 0, 0);
  }
  const RateIntegral integral(gyroscope);
  ASSERT_TRUE(integral.mean_rate(0, 30'000'000));
  EXPECT_NEAR(integral.mean_rate(0, 30'000'000)->x(), 1.5, 1e-12);
  EXPECT_FALSE(integral.mean_rate(0, 30'000'001));
  EXPECT_FALSE(integral.mean_rate(-1, 30'000'000));
}

TEST(GyroscopeCheck, AcceptsAGyroscopeThatFits) {
  EXPECT_EQ(check(images(), gyroscope(0, Matrix3d::Identity())).misfit, "");
  EXPECT_EQ(check(images(), gyroscope(0.01, Matrix3d::Identity())).misfit, "");
}

TEST(GyroscopeCheck, MeasuresAClockThatIsOffByMoreThanHalfAFrame) {
  for (const double late_s : {0.03, -0.05, 0.1}) {
    const auto [misfit, found_s] = check(images(), gyroscope(late_s, Matrix3d::Identity()));
    EXPECT_THAT(misfit, StartsWith("its clock is about "));
    ASSERT_TRUE(found_s) << late_s;
    EXPECT_NEAR(*found_s, late_s, 0.004);
  }
}

TEST(GyroscopeCheck, NamesWrongAxes) {
  const Matrix3d quarter = so3_exp({0, 0, M_PI / 2});
  const auto found = check(images(), gyroscope(0, quarter));
  EXPECT_EQ(found.misfit, "its axes are about 90 deg off");
  EXPECT_FALSE(found.late_s);
}

TEST(GyroscopeCheck, NamesOppositeAxesRatherThanAnotherClock) {
  Gyroscope opposite = gyroscope(0, so3_exp({M_PI, 0, 0}));
  EXPECT_EQ(check(images(), opposite).misfit, "its axes are about 180 deg off");
}

TEST(GyroscopeCheck, NamesRatesThatAreTooLow) {
  for (const double share : {0.0, 1 / 57.3})
    EXPECT_EQ(check(images(), with_rates(share)).misfit, "the images rotate, but it hardly does");
  const GyroscopeCheck half = check(images(), with_rates(0.5));
  EXPECT_THAT(half.misfit, testing::MatchesRegex("its rates are about 0.(49|50|51) of those.*"));
  EXPECT_FALSE(half.late_s);
  EXPECT_EQ(check(images(), with_rates(0.9)).misfit, "");
}

TEST(GyroscopeCheck, IgnoresAGyroscopeAtRestIfTheImagesAreUncertainOrAtRest) {
  constexpr double kUnknown_rad = 0.05;
  EXPECT_EQ(check_gyroscope_against(images(), with_rates(0), kUnknown_rad).misfit, "");
  EXPECT_EQ(check(images(0.02), with_rates(0)).misfit, "");
}

TEST(GyroscopeCheck, NamesStabilizedImagesAndUnrelatedRates) {
  EXPECT_EQ(check(images(0.2), gyroscope(0, Matrix3d::Identity())).misfit,
            "the images rotate less than it does, as stabilized images do");
  EXPECT_THAT(check(images(), gyroscope(20, Matrix3d::Identity())).misfit,
              StartsWith("their rates have a correlation of "));
}

}  // namespace
}  // namespace gpo::test
