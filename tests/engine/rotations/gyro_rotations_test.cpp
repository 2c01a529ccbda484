// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"
#include "engine/rotations/rotations.h"
#include "tests/engine/rotation_error.h"
#include "tests/engine/simulated_window.h"
#include "tests/engine/test_folder.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using Eigen::Vector3d, testing::HasSubstr;

/// Returns 200 Hz over two seconds at a constant rate.
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

std::vector<std::int64_t> thirty_times() {
  std::vector<std::int64_t> times;
  for (int i = 0; i < 30; ++i) times.push_back(1'101'234'567 + 33'333'333LL * i);
  return times;
}

std::string rotations_error(const Gyroscope& gyroscope, const std::vector<std::int64_t>& times) {
  return error_of([&] { gyro_rotations(gyroscope, times); });
}

TEST(GyroRotations, IntegrateAVaryingRateAboutOneAxis) {
  Gyroscope gyroscope = constant_rate(Vector3d::Zero());
  for (std::size_t k = 0; k < 400; ++k)
    gyroscope.rates_rad_s[k].z() = 1.5 * static_cast<double>(k) * 0.005;
  const auto times = thirty_times();
  const auto R = gyro_rotations(gyroscope, times);
  const auto angle = [](std::int64_t t) {
    return 0.75 * std::pow(static_cast<double>(t - 1'000'000'000) * 1e-9, 2);
  };
  EXPECT_LT((R[29] - so3_exp({0, 0, angle(times[29]) - angle(times[0])})).norm(), 1e-9);
}

TEST(GyroRotations, MatchAConstantRateWithBiasExtrinsicsAndClockOffset) {
  const Vector3d rate(0.3, -0.5, 0.8);
  Gyroscope gyroscope = constant_rate(rate);
  gyroscope.bias_rad_s = Vector3d(0.01, 0.02, -0.03);
  gyroscope.R_gyro_camera = so3_exp({1, -2, 0.5});
  const auto times = thirty_times();
  const Vector3d in_camera = gyroscope.R_gyro_camera.transpose() * (rate - gyroscope.bias_rad_s);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double seconds = static_cast<double>(times[i] - times[0]) * 1e-9;
    EXPECT_LT((gyro_rotations(gyroscope, times)[i] - so3_exp(in_camera * seconds)).norm(), 1e-12);
  }
  Gyroscope late = gyroscope;  // the same samples on a clock that runs ahead by 20 ms
  for (auto& t : late.timestamps_ns) t += 20'000'000;
  late.time_offset_ns = 20'000'000;
  EXPECT_LT((gyro_rotations(late, times)[29] - gyro_rotations(gyroscope, times)[29]).norm(), 1e-12);
}

/// Returns rates that vary by some rad/s, at times that jitter by a fifth of a period, with
/// extrinsics, bias and clock offset.
Gyroscope varying_rate(std::uint64_t seed) {
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

/// Compares a derivative of the rotations by right perturbation, one per frame, with the difference
/// quotient. `move` changes a parameter of the gyroscope by a number of `step`s.
void expect_slopes(const std::vector<Vector3d>& slopes,
                   const Gyroscope& gyroscope,
                   const std::function<void(Gyroscope&, int steps)>& move,
                   double step,
                   double tolerance) {
  Gyroscope before = gyroscope, after = gyroscope;
  move(before, -1);
  move(after, 1);
  const auto R_before = gyro_rotations(before, thirty_times());
  const auto R_after = gyro_rotations(after, thirty_times());
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    const Vector3d expected = so3_log(R_before[i].transpose() * R_after[i]) / (2 * step);
    EXPECT_LT((slopes[i] - expected).norm(), tolerance) << "frame " << i;
  }
}

// The derivative by the clock is accurate to the linear interpolation of the samples: 0.1 % of the
// rates, which reach 5 rad/s.
TEST(GyroSensitivity, MatchesDifferenceQuotients) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const Gyroscope gyroscope = varying_rate(seed);
    const GyroSensitivity gyro = *sensitive_gyro_rotations(gyroscope, thirty_times()).gyro;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<Vector3d> d_bias;
      for (const Eigen::Matrix3d& D : gyro.d_bias) d_bias.emplace_back(D.col(axis));
      const auto move = [&](Gyroscope& moved, int steps) {
        moved.bias_rad_s[axis] += 1e-5 * steps;
      };
      expect_slopes(d_bias, gyroscope, move, 1e-5, 1e-8);
    }
    const auto move = [](Gyroscope& moved, int steps) { moved.time_offset_ns += 20'000 * steps; };
    expect_slopes(gyro.d_offset, gyroscope, move, 2e-5, 5e-3);
  }
}

// Angular accelerations reach 20 rad/s^2.
TEST(GyroSensitivity, PredictsClocksThatAreTenMillisecondsLateToSecondOrder) {
  constexpr double kLate_s = 0.01;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Gyroscope gyroscope = varying_rate(seed);
    const Rotations now = sensitive_gyro_rotations(gyroscope, thirty_times());
    gyroscope.time_offset_ns += std::llround(1e9 * kLate_s);
    const auto late = gyro_rotations(gyroscope, thirty_times());
    double first_order = 0, second_order = 0;
    for (std::size_t i = 1; i < late.size(); ++i) {
      const Vector3d change = so3_log(now.R_wc[i].transpose() * late[i]);
      const Vector3d predicted = kLate_s * now.gyro->d_offset[i];
      const Vector3d curve = 0.5 * kLate_s * kLate_s * now.gyro->d2_offset[i];
      first_order += (change - predicted).norm();
      second_order += (change - predicted - curve).norm();
    }
    EXPECT_LT(second_order, 0.2 * first_order) << seed;
  }
}

/// The first frame may be before the first sample, by up to 1.5 periods.
TEST(GyroSensitivity, IsFiniteBeyondTheSamples) {
  Gyroscope gyroscope = constant_rate(Vector3d(0.1, 0.2, 0.3));
  for (std::int64_t& t : gyroscope.timestamps_ns) t = 1'000'000'000 + 4 * (t - 1'000'000'000);
  for (const std::int64_t before_ns : {0, 5'000'000, 10'000'000, 20'000'000}) {
    const std::int64_t first_ns = gyroscope.timestamps_ns.front() - before_ns;
    const std::vector times{first_ns, first_ns + 500'000'000};
    const Rotations rotations = sensitive_gyro_rotations(gyroscope, times);
    for (const Vector3d& d2 : rotations.gyro->d2_offset) EXPECT_TRUE(d2.allFinite()) << before_ns;
  }
}

TEST(GyroSensitivity, HasBiasPriorAndNoise) {
  Gyroscope gyroscope = constant_rate(Vector3d(0.1, 0.2, 0.3));
  gyroscope.bias_rad_s = Vector3d(0.01, 0.02, -0.03);
  gyroscope.bias_sigma_rad_s = 0.002;
  gyroscope.noise_density = 0.0007;
  const Rotations rotations = sensitive_gyro_rotations(gyroscope, thirty_times());
  const GyroSensitivity& gyro = *rotations.gyro;
  EXPECT_EQ(rotations.model, RotationModel::bias);
  EXPECT_EQ(gyro.bias_rad_s, gyroscope.bias_rad_s);
  EXPECT_EQ(gyro.prior_rad_s, gyroscope.bias_rad_s);
  EXPECT_EQ(gyro.prior_sigma_rad_s, 0.002);
  EXPECT_EQ(gyro.noise_density, 0.0007);
  EXPECT_EQ(gyro.d_bias.size(), 30U);
  EXPECT_EQ(gyro.d_offset.size(), 30U);
}

TEST(GyroSensitivity, HoldsAStatedBiasMoreTightlyThanAnUnknownOne) {
  Gyroscope gyroscope = constant_rate(Vector3d(0.1, 0.2, 0.3));
  const auto held_rad_s = [&] {
    const Rotations rotations = sensitive_gyro_rotations(gyroscope, thirty_times());
    EXPECT_EQ(rotations.gyro->prior_sigma_rad_s, gyroscope.bias_sigma_rad_s);
    return std::sqrt(rotations.gyro->bias_covariance(0, 0));
  };
  EXPECT_DOUBLE_EQ(held_rad_s(), 0.1);
  gyroscope.bias_known = true;
  EXPECT_DOUBLE_EQ(held_rad_s(), kStatedBiasSigma_rad_s);
  gyroscope.bias_sigma_rad_s = 0.02;
  EXPECT_DOUBLE_EQ(held_rad_s(), 0.02);
}

TEST(GyroRotations, LocateGapsAndRejectUnorderedSamplesAndUncoveredWindows) {
  Gyroscope gyroscope = constant_rate(Vector3d::Zero());
  const auto cut = [](auto& values) { values.erase(values.begin() + 100, values.begin() + 120); };
  cut(gyroscope.timestamps_ns);
  cut(gyroscope.lines);
  cut(gyroscope.rates_rad_s);
  EXPECT_THAT(rotations_error(gyroscope, thirty_times()),
              HasSubstr("imu0/data.csv:122: gap of 0.105 s"));
  // A gap outside of the window is harmless.
  EXPECT_EQ(rotations_error(gyroscope, {1'650'000'000, 1'700'000'000}), "no error");
  Gyroscope whole = constant_rate(Vector3d::Zero());
  EXPECT_THAT(rotations_error(whole, {900'000'000, 1'100'000'000}),
              HasSubstr("0.100 s after the window's first frame"));
  EXPECT_THAT(rotations_error(whole, {1'100'000'000, 3'100'000'000}),
              HasSubstr("0.105 s before the window's last frame"));
  std::swap(whole.timestamps_ns[100], whole.timestamps_ns[101]);
  EXPECT_THAT(rotations_error(whole, thirty_times()), HasSubstr("imu0/data.csv:103: time stamp"));
}

TEST(RotationSource, ListsKnownValuesForATypo) {
  EXPECT_EQ(
      error_of([] { choice<RotationSource>("gyr"); }),
      "rotations: unknown value 'gyr', expected one of automatic, raw, gyro, "
      "gyro-calibrated, averaging, averaging-first, averaging-second, five-point, direct, truth");
}

constexpr double kFrame_s = 0.033333333;
const Vector3d kGyroBias(0.004, -0.006, 0.003);

/// Returns a gyroscope of 1 kHz that rotates as the simulated camera does, with constant rates
/// between frames, an unknown bias and rotated axes.
Gyroscope biased_gyroscope(const Simulation& s) {
  Gyroscope gyroscope;
  gyroscope.bias_sigma_rad_s = 0.01;
  gyroscope.R_gyro_camera = so3_exp({0.3, -1.2, 0.5});
  const auto& times = s.window.timestamps_ns;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const Vector3d rate_c =
        so3_log(s.cameras[i].R_wc.transpose() * s.cameras[i + 1].R_wc) / kFrame_s;
    for (std::int64_t t = times[i] + 500'000; t < times[i + 1]; t += 1'000'000) {
      gyroscope.timestamps_ns.push_back(t);
      gyroscope.lines.push_back(static_cast<int>(gyroscope.lines.size()) + 2);
      gyroscope.rates_rad_s.push_back(gyroscope.R_gyro_camera * rate_c + kGyroBias);
    }
  }
  return gyroscope;
}

double last_error_deg(const Rotations& rotations, const Simulation& s) {
  return rotation_error_deg(rotations.R_wc.back(), s.cameras.back().R_wc);
}

TEST(GyroCalibration, FindsTheBiasDespiteWrongRotationsAndKeepsThePriorInAShortWindow) {
  const Simulation s = simulate({.motion = Motion::orbit, .seed = 4});
  const Gyroscope gyroscope = biased_gyroscope(s);
  std::vector<Eigen::Matrix3d> R_wc = s.window.R_wc;
  const auto error = [&](std::span<const std::int64_t> times) {
    return (fit_gyro_bias(gyroscope, times, {R_wc, ""}).bias_rad_s - kGyroBias).norm();
  };
  // The prior at zero reduces it by (0.001 rad / (0.01 rad/s x 0.58 s))^2.
  EXPECT_LT(error(s.window.timestamps_ns), 0.08 * kGyroBias.norm());
  for (const int i : {7, 15, 22}) R_wc[i] = R_wc[i] * so3_exp({0.2, -0.1, 0.1});
  EXPECT_LT(error(s.window.timestamps_ns), 0.15 * kGyroBias.norm());
  const std::span times(s.window.timestamps_ns.data(), 4);
  const std::vector<Eigen::Matrix3d> few_R_wc(s.window.R_wc.begin(), s.window.R_wc.begin() + 4);
  // The same ratio leaves 0.33 of the bias for 0.07 s.
  EXPECT_LT(fit_gyro_bias(gyroscope, times, {few_R_wc, ""}).bias_rad_s.norm(),
            0.4 * kGyroBias.norm());
}

// An approach constrains the normal, and so the rotations, only weakly: there it must not harm.
TEST(GyroCalibration, ReducesTheErrorOfABiasedGyroscope) {
  for (const Motion motion : {Motion::sideways, Motion::orbit, Motion::approach, Motion::wander}) {
    std::vector<double> raw, calibrated;
    for (std::uint64_t seed = 1; seed <= 11; ++seed) {
      const Simulation s = simulate({.motion = motion, .seed = seed});
      const Gyroscope gyroscope = biased_gyroscope(s);
      raw.push_back(last_error_deg({gyro_rotations(gyroscope, s.window.timestamps_ns), ""}, s));
      const Rotations rotations = calibrated_gyro_rotations(gyroscope, s.window);
      ASSERT_EQ(rotations.reason, "") << static_cast<int>(motion) << " seed " << seed;
      ASSERT_TRUE(rotations.gyro);
      calibrated.push_back(last_error_deg(rotations, s));
    }
    const double factor = motion == Motion::approach ? 1.1 : 0.4;
    EXPECT_LT(median(calibrated), factor * median(raw)) << static_cast<int>(motion);
  }
}

// Averaging alone reports some of these windows as ambiguous.
TEST(GyroCalibration, ResolvesAmbiguousWindows) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Simulation s = simulate({.motion = Motion::approach, .travel = 0.1, .seed = seed});
    const Rotations rotations = calibrated_gyro_rotations(biased_gyroscope(s), s.window);
    ASSERT_EQ(rotations.reason, "");
    EXPECT_LT(last_error_deg(rotations, s), 1.0) << "seed " << seed;
  }
}

TEST(GyroCalibration, FailsForAWindowWithoutInliers) {
  Simulation s = simulate({});
  for (auto& frame : s.window.inlier) frame.assign(150, false);
  for (const Rotations& rotations :
       {calibrated_gyro_rotations(biased_gyroscope(s), s.window), averaged_rotations(s.window)}) {
    EXPECT_TRUE(rotations.R_wc.empty());
    EXPECT_THAT(rotations.reason, HasSubstr("too few tracks join frame 1"));
  }
}

}  // namespace
}  // namespace gpo::test
