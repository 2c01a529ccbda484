// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rotations/gyroscope_check.h"

#include "engine/geometry/pose.h"
#include "engine/rotations/gyroscope_alignment.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d, testing::HasSubstr, testing::StartsWith;

Vector3d camera_rate_at(double t_s) {
  return {0.5 * std::sin(5.1 * t_s) + 0.2 * std::cos(13 * t_s),
          0.6 * std::cos(3.7 * t_s + 1) + 0.1 * std::sin(17 * t_s),
          0.4 * std::sin(4.3 * t_s + 2)};
}

std::int64_t to_ns(double seconds) { return std::llround(1e9 * seconds); }

/// Frames at 30 Hz whose rates are `share` of the true ones, with 0.02 deg of noise each.
ImageRotations images(double share = 1, int frames = 30) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> gauss(0, radians(0.02));
  ImageRotations window;
  Matrix3d R = Matrix3d::Identity();
  for (int i = 0; i < frames; ++i) {
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
  return check_gyroscope_against({&window, 1}, gyroscope, kSigma_rad);
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
  EXPECT_EQ(check(images(), gyroscope(0, Matrix3d::Identity())).misfit, GyroscopeMisfit::none);
  EXPECT_EQ(check(images(), gyroscope(0.01, Matrix3d::Identity())).misfit, GyroscopeMisfit::none);
}

TEST(GyroscopeCheck, MeasuresAClockThatIsOffByMoreThanHalfAFrame) {
  for (const double late_s : {0.03, -0.05, 0.1}) {
    const GyroscopeCheck found = check(images(), gyroscope(late_s, Matrix3d::Identity()));
    ASSERT_TRUE(found.late_s) << late_s;
    EXPECT_THAT(sentence_of(found), StartsWith("its clock is about "));
    EXPECT_NEAR(*found.late_s, late_s, 0.004);
  }
}

TEST(GyroscopeCheck, NamesWrongAxes) {
  const Matrix3d quarter = so3_exp({0, 0, M_PI / 2});
  const auto found = check(images(), gyroscope(0, quarter));
  EXPECT_EQ(sentence_of(found), "its axes are about 90 deg off");
  EXPECT_FALSE(found.late_s);
}

TEST(GyroscopeCheck, NamesOppositeAxesRatherThanAnotherClock) {
  Gyroscope opposite = gyroscope(0, so3_exp({M_PI, 0, 0}));
  EXPECT_EQ(sentence_of(check(images(), opposite)), "its axes are about 180 deg off");
}

TEST(GyroscopeCheck, NamesRatesThatAreTooLow) {
  for (const double share : {0.0, 0.1})
    EXPECT_EQ(sentence_of(check(images(), with_rates(share))),
              "the images rotate, but it hardly does");
  const GyroscopeCheck half = check(images(), with_rates(0.5));
  EXPECT_THAT(sentence_of(half),
              testing::MatchesRegex("its rates are about 0.(49|50|51) of those.*"));
  EXPECT_FALSE(half.late_s);
  EXPECT_EQ(check(images(), with_rates(0.9)).misfit, GyroscopeMisfit::none);
}

TEST(GyroscopeCheck, IgnoresAGyroscopeAtRestIfTheImagesAreUncertainOrAtRest) {
  constexpr double kUnknown_rad = 0.05;
  const ImageRotations window = images();
  EXPECT_EQ(check_gyroscope_against({&window, 1}, with_rates(0), kUnknown_rad).misfit,
            GyroscopeMisfit::none);
  EXPECT_EQ(check(images(0.02), with_rates(0)).misfit, GyroscopeMisfit::none);
}

TEST(GyroscopeCheck, NamesStabilizedImagesAndUnrelatedRates) {
  EXPECT_EQ(sentence_of(check(images(0.2), gyroscope(0, Matrix3d::Identity()))),
            "the images rotate less than it does, as stabilized images do");
  EXPECT_THAT(sentence_of(check(images(), gyroscope(20, Matrix3d::Identity()))),
              StartsWith("their rates have a correlation of "));
}

Gyroscope with_axes(const Matrix3d& axes, Gyroscope made) {
  for (Vector3d& rate : made.rates_rad_s) rate = axes * rate;
  return made;
}

Matrix3d swapped(int a, int b) {
  Matrix3d axes = Matrix3d::Identity();
  axes.row(a).swap(axes.row(b));
  return axes;
}

TEST(GyroscopeCheck, NamesUnits) {
  const std::pair<double, const char*> units[] = {
      {57.29578, "as in degrees per second"},
      {1000, "as in milliradians per second"},
      {57295.78, "as in millidegrees per second"},
      {1 / 57.29578, "as in radians that were converted from degrees twice"}};
  for (const int frames : {10, 30})
    for (const auto& [factor, name] : units) {
      const GyroscopeCheck found = check(images(1, frames), with_rates(factor));
      EXPECT_EQ(found.misfit, GyroscopeMisfit::unit) << name << frames;
      EXPECT_THAT(sentence_of(found), HasSubstr(name)) << frames;
      EXPECT_NEAR(found.rad_s_per_unit * factor, 1, 1e-6);
    }
}

TEST(GyroscopeCheck, NamesLeftHandedAxesWhateverTheRotationToTheCamera) {
  const Matrix3d R = so3_exp({0.5, -1, 2});
  const auto sentence = [&](const Matrix3d& axes, int frames) {
    Gyroscope made = with_axes(axes, gyroscope(0, R));
    made.R_gyro_camera = R;
    return sentence_of(check(images(1, frames), made));
  };
  for (const int frames : {10, 30}) {
    EXPECT_THAT(sentence(Vector3d(-1, 1, 1).asDiagonal(), frames),
                StartsWith("it fits if its x axis is negated: its axes are left-handed"));
    EXPECT_THAT(sentence(Vector3d(1, -1, 1).asDiagonal(), frames),
                StartsWith("it fits if its y axis is negated: its axes are left-handed"));
    EXPECT_THAT(sentence(Vector3d(1, 1, -1).asDiagonal(), frames),
                StartsWith("it fits if its z axis is negated: its axes are left-handed"));
    EXPECT_THAT(sentence(Matrix3d::Identity(), frames), "");
  }
  EXPECT_THAT(sentence(swapped(0, 1), 30),
              StartsWith("it fits if its x and y axes are swapped: its axes are left-handed"));
  EXPECT_THAT(sentence(swapped(1, 2), 30),
              StartsWith("it fits if its y and z axes are swapped: its axes are left-handed"));
}

TEST(GyroscopeCheck, AdviceMendsTheFileOfRates) {
  Gyroscope made = with_axes(Vector3d(1, -1, 1).asDiagonal(), with_rates(57.29578));
  made.file = "imu0/data.csv";
  const GyroscopeCheck found = check(images(), made);
  EXPECT_EQ(found.misfit, GyroscopeMisfit::mirrored);
  EXPECT_EQ(advice_of(found, made),
            "correct the rates: awk -F, -v OFS=, '/^[0-9]/ { for (i = 2; i < 5; ++i) $i *= "
            "0.0174532925; x = $2; y = $3; z = $4; $3 = -y; } 1' 'imu0/data.csv' > rates.csv");
  made.file = "video.mp4";
  EXPECT_THAT(advice_of(found, made), HasSubstr("multiply them by 0.0174532925"));
}

TEST(GyroscopeCheck, NamesAnInvertedExtrinsicRotation) {
  Gyroscope inverse = gyroscope(0, so3_exp({0.5, -1, 2}));
  inverse.R_gyro_camera = so3_exp({-0.5, 1, -2});
  EXPECT_EQ(check(images(), inverse).misfit, GyroscopeMisfit::inverted);
}

}  // namespace
}  // namespace gpo::test
