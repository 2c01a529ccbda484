// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/window/gyroscope_rest.h"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using Eigen::Vector3d;

const Vector3d kRestBias{0.02, -0.08, 0.01}, kRestUp{0.1, -5.6, -8};

/// Samples at 200 Hz for 2 s; the motions are added to a sensor at rest.
struct RestOptions {
  double rate_noise = 0.003, acceleration_noise = 0.03;  ///< 0 with a motion: exact values
  double rate_step = 0, acceleration_step = 0;           ///< step between quantized values; 0: none
  std::function<Vector3d(double t_s)> rate = [](double) { return Vector3d::Zero(); };
  std::function<Vector3d(double t_s)> acceleration = rate;
  bool accelerometer = true;
};

Vector3d quantized(const Vector3d& value, double step) {
  return step > 0 ? Vector3d(step * (value / step).array().round()) : value;
}

Gyroscope sensors(const RestOptions& options) {
  Gyroscope gyroscope;
  std::mt19937_64 random(3);
  std::normal_distribution<double> gauss;
  const auto noise = [&](double sigma) -> Vector3d {
    return sigma * Vector3d(gauss(random), gauss(random), gauss(random));
  };
  for (int k = 0; k < 400; ++k) {
    const double t_s = k / 200.0;
    gyroscope.timestamps_ns.push_back(5'000'000LL * k);
    gyroscope.rates_rad_s.push_back(
        quantized(kRestBias + options.rate(t_s) + noise(options.rate_noise), options.rate_step));
    if (options.accelerometer)
      gyroscope.accelerations_m_s2.push_back(
          quantized(kRestUp + options.acceleration(t_s) + noise(options.acceleration_noise),
                    options.acceleration_step));
  }
  return gyroscope;
}

std::optional<SensorsAtRest> at_rest(const RestOptions& options) {
  const Gyroscope gyroscope = sensors(options);
  return sensors_at_rest(gyroscope, 0, gyroscope.rates_rad_s.size());
}

Vector3d swaying(double amplitude, double rate_hz, double t_s) {
  return amplitude * std::sin(2 * M_PI * rate_hz * t_s) * Vector3d::UnitX();
}

TEST(SensorsAtRest, MeasuresBiasAndGravity) {
  const auto rest = at_rest({});
  ASSERT_TRUE(rest && rest->mean_m_s2);
  EXPECT_LT((rest->mean_rad_s - kRestBias).norm(), 0.001);
  EXPECT_LT((*rest->mean_m_s2 - kRestUp).norm(), 0.01);
  const auto alone = at_rest({.accelerometer = false});
  ASSERT_TRUE(alone);
  EXPECT_FALSE(alone->mean_m_s2);
}

TEST(SensorsAtRest, AcceptsQuantizedValues) {
  EXPECT_TRUE(at_rest({.rate_noise = 0.0005, .rate_step = 0.001}));
  EXPECT_TRUE(at_rest({.acceleration_noise = 0.01, .acceleration_step = 0.04}));
}

TEST(SensorsAtRest, RejectsMotionsAndVibration) {
  const auto by_hand = [](double t_s) { return swaying(0.012, 1.5, t_s); };
  const auto pushed = [](double t_s) { return swaying(0.1, 0.7, t_s); };
  const auto motor = [](double t_s) { return swaying(0.03, 37, t_s); };
  EXPECT_FALSE(at_rest({.rate = by_hand}));
  EXPECT_FALSE(at_rest({.acceleration = pushed}));
  EXPECT_FALSE(at_rest({.rate = motor}));
  EXPECT_FALSE(at_rest({.acceleration = [](double) { return Vector3d(0, -3, 0); }}));
}

TEST(SensorsAtRest, BrokenSensorsDetermineNothing) {
  EXPECT_FALSE(at_rest({.rate_noise = 0}));
  const auto dead = at_rest({.acceleration_noise = 0});
  ASSERT_TRUE(dead);  // the same as without an accelerometer
  EXPECT_FALSE(dead->mean_m_s2);
  const Vector3d not_measured = Vector3d::Constant(NAN);
  EXPECT_FALSE(at_rest({.acceleration = [&](double t_s) {
    return t_s > 1 && t_s < 1.1 ? not_measured : Vector3d::Zero();
  }}));
}

TEST(QuietSpans, AreTheSpansWithoutMotion) {
  const Gyroscope gyroscope = sensors({.rate = [](double t_s) {
    return t_s > 0.6 && t_s < 1 ? Vector3d(0.5, 0, 0) : Vector3d::Zero();
  }});
  const std::vector<QuietSpan> spans = quiet_spans(gyroscope);
  ASSERT_EQ(spans.size(), 2U);
  EXPECT_NEAR(static_cast<double>(spans[0].end - spans[0].begin), 190, 15);
  EXPECT_NEAR(static_cast<double>(spans[1].end - spans[1].begin), 110, 15);
  for (const QuietSpan& span : spans) EXPECT_LT((span.mean_rad_s - kRestBias).norm(), 0.001);
}

TEST(QuietSpans, DoNotCrossGapsAndAreNotShort) {
  Gyroscope gyroscope = sensors({});
  for (std::size_t k = 200; k < 400; ++k) gyroscope.timestamps_ns[k] += 500'000'000;
  EXPECT_EQ(quiet_spans(gyroscope).size(), 2U);
  gyroscope.timestamps_ns.resize(70);
  gyroscope.rates_rad_s.resize(70);
  EXPECT_TRUE(quiet_spans(gyroscope).empty());
  EXPECT_TRUE(quiet_spans({}).empty());
}

TEST(SigmasFromPrior, AreThoseOfTheBias) {
  Gyroscope gyroscope;
  gyroscope.bias_rad_s = kRestBias;
  gyroscope.bias_sigma_rad_s = 0.002;
  EXPECT_NEAR(sigmas_from_prior(gyroscope, kRestBias + Vector3d(0, 0.012, 0)), 6, 1e-9);
}

}  // namespace
}  // namespace gpo::test
