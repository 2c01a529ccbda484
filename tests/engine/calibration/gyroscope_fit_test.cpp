// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/gyroscope_fit.h"

#include "engine/calibration/calibration_report.h"
#include "engine/inspection/studies/studies.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/engine/largest.h"
#include "tests/engine/rotation_error.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d, testing::HasSubstr;

struct Truth {
  Matrix3d R_gyro_camera = Matrix3d::Identity();
  double offset_s = 0;
  Vector3d bias = Vector3d::Zero();
  double drift = 0;
};

struct Recorded {
  std::vector<ImageRotations> windows;
  Gyroscope gyroscope;
};

/// Rates of a hand-held camera, in its own axes.
Vector3d rate_at(double t_s) {
  return {0.5 * std::sin(5.1 * t_s) + 0.2 * std::cos(13 * t_s),
          0.6 * std::cos(3.7 * t_s + 1) + 0.1 * std::sin(17 * t_s),
          0.4 * std::sin(4.3 * t_s + 2)};
}

constexpr std::int64_t kBegin_ns = 1'000'000'000'000;

std::int64_t ns(double seconds) { return kBegin_ns + std::llround(1e9 * seconds); }

/// Windows of ten frames at 30 Hz with `noise_rad` on each axis, and a gyroscope of 200 Hz with
/// 0.002 rad/s.
Recorded record(const Truth& truth, double seconds, double noise_rad, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss;
  const auto noise = [&](double sigma) -> Vector3d {
    return sigma * Vector3d(gauss(random), gauss(random), gauss(random));
  };
  Recorded recorded;
  for (double from_s = 0; from_s + 0.3 < seconds; from_s += std::max(0.3, seconds / 80)) {
    ImageRotations window;
    Matrix3d R = Matrix3d::Identity();
    for (int i = 0; i < 10; ++i) {
      const double at_s = from_s + i / 30.0;
      window.timestamps_ns.push_back(ns(at_s));
      window.R_wc.emplace_back(i == 0 ? R : Matrix3d(R * so3_exp(noise(noise_rad))));
      for (int k = 0; k < 100; ++k) R = R * so3_exp(rate_at(at_s + (k + 0.5) / 3000) / 3000);
    }
    recorded.windows.push_back(window);
  }
  for (double at_s = -2; at_s < seconds + 2; at_s += 0.005) {
    const double camera_s = at_s - truth.offset_s - truth.drift * (at_s - seconds / 2);
    recorded.gyroscope.timestamps_ns.push_back(ns(at_s));
    recorded.gyroscope.rates_rad_s.emplace_back(truth.R_gyro_camera * rate_at(camera_s) +
                                                truth.bias + noise(0.002));
  }
  return recorded;
}

Matrix3d any_rotation(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss;
  const double w = gauss(random), x = gauss(random), y = gauss(random), z = gauss(random);
  return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
}

/// Fits a gyroscope; throws, and so fails the test, if that is impossible.
GyroscopeFit fitted(const std::vector<ImageRotations>& windows, const Gyroscope& gyroscope) {
  GyroscopeFit fit = fit_gyroscope(windows, gyroscope);
  if (!fit.ok) throw std::runtime_error(fit.reason);
  return fit;
}

TEST(GyroscopeFit, EstimatesRotationClockAndBias) {
  double squares = 0;
  int numbers = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Truth truth{any_rotation(seed),
                      0.02 * static_cast<double>(seed) - 0.4,
                      0.03 * any_rotation(seed + 99).col(0)};
    const Recorded recorded = record(truth, 5, 0.002, seed);
    const GyroscopeFit fit = fitted(recorded.windows, recorded.gyroscope);
    EXPECT_LT(rotation_error_deg(fit.R_gyro_camera, truth.R_gyro_camera), 1) << seed;
    EXPECT_NEAR(fit.time_offset_s, truth.offset_s, 0.002) << seed;
    EXPECT_LT((fit.bias_rad_s - truth.bias).norm(), 0.01) << seed;
    const Vector3d off = degrees(1) * so3_log(fit.R_gyro_camera.transpose() * truth.R_gyro_camera);
    squares += off.cwiseQuotient(fit.rotation_sigma_deg).squaredNorm();
    squares += (fit.bias_rad_s - truth.bias).cwiseQuotient(fit.bias_sigma_rad_s).squaredNorm();
    squares += std::pow((fit.time_offset_s - truth.offset_s) / fit.time_offset_sigma_s, 2);
    numbers += 7;
  }
  // The mean of squared normalized errors is one, for few clusters a bit less.
  EXPECT_GT(squares / numbers, 0.5);
  EXPECT_LT(squares / numbers, 1.5);
}

TEST(GyroscopeFit, AWrongPrincipalPointTurnsTheCameraAxes) {
  GyroscopeFit fit;
  fit.rotation_sigma_deg = {0.3, 0, 0.1};
  Camera camera{640, 480, 500, 400, 320, 240, Distortion::none, {}};
  GyroscopeFit typical = fit;
  add_lens_error(typical, camera);
  EXPECT_NEAR(typical.rotation_sigma_deg.x(), std::hypot(0.3, degrees(1.92 / 400)), 1e-12);
  EXPECT_NEAR(typical.rotation_sigma_deg.y(), degrees(1.92 / 500), 1e-12);
  EXPECT_EQ(typical.rotation_sigma_deg.z(), 0.1);
  camera.sigmas = {1, 1, 5, 0};
  add_lens_error(fit, camera);
  EXPECT_EQ(fit.rotation_sigma_deg.x(), 0.3);
  EXPECT_NEAR(fit.rotation_sigma_deg.y(), degrees(5.0 / 500), 1e-12);
}

TEST(GyroscopeFit, LeavesOutWindowsThatDisagree) {
  const Truth truth{any_rotation(3), 0.04, {0.01, -0.02, 0.005}};
  Recorded recorded = record(truth, 6, 0.001, 3);
  for (std::size_t w = 0; w < recorded.windows.size(); w += 5)
    for (std::size_t i = 1; i < recorded.windows[w].R_wc.size(); ++i)
      recorded.windows[w].R_wc[i] *= so3_exp(0.02 * static_cast<double>(i) * Vector3d(1, -1, 0.5));
  const GyroscopeFit fit = fitted(recorded.windows, recorded.gyroscope);
  EXPECT_EQ(fit.outliers, 4);
  EXPECT_LT(rotation_error_deg(fit.R_gyro_camera, truth.R_gyro_camera), 0.3);
  EXPECT_NEAR(fit.time_offset_s, truth.offset_s, 0.001);
}

TEST(GyroscopeFit, EstimatesTheClockDriftOfALongRecording) {
  const Truth truth{any_rotation(4), 0.1, {0.01, 0, 0}, 2e-4};
  const Recorded recorded = record(truth, 120, 0.001, 4);
  const GyroscopeFit fit = fitted(recorded.windows, recorded.gyroscope);
  ASSERT_TRUE(fit.drift);
  EXPECT_NEAR(*fit.drift, truth.drift, std::max(2e-5, 4 * fit.drift_sigma));
}

TEST(GyroscopeFit, WarnsAboutMirroredAxesAndRefusesStillFewOrUncoveredImages) {
  Recorded recorded = record({}, 5, 0.001, 5);
  for (Vector3d& rate : recorded.gyroscope.rates_rad_s) rate.x() = -rate.x();
  const GyroscopeFit fit = fit_gyroscope(recorded.windows, recorded.gyroscope);
  ASSERT_FALSE(fit.warnings.empty());
  EXPECT_THAT(fit.warnings[0], HasSubstr("mirrored"));
  Recorded still = record({}, 5, 0.001, 6);
  for (Vector3d& rate : still.gyroscope.rates_rad_s) rate *= 0;
  for (ImageRotations& window : still.windows)
    for (Matrix3d& R : window.R_wc) R.setIdentity();
  EXPECT_FALSE(fit_gyroscope(still.windows, still.gyroscope).ok);

  const Recorded good = record({}, 5, 0.001, 7);
  EXPECT_THAT(fit_gyroscope({good.windows[0]}, good.gyroscope).reason,
              HasSubstr("the images determine 9 rotations, at least 12 are needed"));
  Gyroscope elsewhere = good.gyroscope;
  for (auto& time : elsewhere.timestamps_ns) time += 1'000'000'000'000;
  EXPECT_THAT(fit_gyroscope(good.windows, elsewhere).reason, HasSubstr("does not cover"));
}

class RealGyroscope : public testing::Test {
 protected:
  void open(const std::string& name) {
    const auto folder = std::filesystem::path(GPO_SHARED_DIR) / "data" / name;
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
    recording_ = open_recording(folder);
    windows_ = rotations_over_recording(recording_);
  }
  /// The recording's gyroscope with rotated axes and a late clock.
  Gyroscope rotated(const Matrix3d& R, double late_s) const {
    Gyroscope gyroscope = *recording_->gyroscope;
    for (Vector3d& rate : gyroscope.rates_rad_s) rate = R * rate;
    for (auto& time : gyroscope.timestamps_ns) time += std::llround(1e9 * late_s);
    return gyroscope;
  }

  std::shared_ptr<const Recording> recording_;
  std::vector<ImageRotations> windows_;
};

std::vector<Matrix3d> axis_permutations() {
  std::vector<Matrix3d> all;
  for (const auto& [x, y] : {std::pair(0, 0), {0, 1}, {0, 2}, {0, -1}, {1, 0}, {-1, 0}})
    for (int z = 0; z < 4; ++z)
      all.emplace_back(so3_exp(M_PI / 2 * Vector3d(x, y, 0)) *
                       so3_exp(M_PI / 2 * Vector3d(0, 0, z)));
  return all;
}

TEST_F(RealGyroscope, PhoneIsAlignedForAnyNamingOfTheAxes) {
  open("phone-street");
  if (IsSkipped()) return;
  for (const Matrix3d& R : axis_permutations()) {
    const GyroscopeFit fit = fitted(windows_, rotated(R, 0));
    EXPECT_LT(rotation_error_deg(fit.R_gyro_camera, R * recording_->gyroscope->R_gyro_camera), 5);
    EXPECT_GT(fit.time_offset_s, 0.006);  // +8 to 10 ms by another program
    EXPECT_LT(fit.time_offset_s, 0.012);
    EXPECT_GT(fit.correlation, 0.9);
  }
}

TEST_F(RealGyroscope, EurocAgreesWithItsCalibration) {
  open("euroc-room");
  if (IsSkipped()) return;
  const Vector3d bias(-0.0022, 0.0208, 0.0765);  // published with this flight
  for (const double late_s : {0.0, 0.035})
    for (const Vector3d& rotation : {Vector3d(0, 0, 0), Vector3d(1, -2, 0.5)}) {
      const Matrix3d R = so3_exp(rotation);
      const GyroscopeFit fit = fitted(windows_, rotated(R, late_s));
      const Vector3d off = degrees(1) * so3_log(fit.R_gyro_camera.transpose() * R *
                                                recording_->gyroscope->R_gyro_camera);
      EXPECT_LT(off.norm(), 1.5);
      EXPECT_LT(largest(off.cwiseQuotient(fit.rotation_sigma_deg)), 3);
      EXPECT_NEAR(fit.time_offset_s, late_s, 0.005);
      EXPECT_LT((fit.bias_rad_s - R * bias).norm(), 0.01);
    }
  const auto reason = [&](const Matrix3d& R, double late_s) {
    return why_it_does_not_fit(
        fit_gyroscope(windows_, rotated(R, late_s)), *recording_->gyroscope, 0.05);
  };
  EXPECT_EQ(reason(Matrix3d::Identity(), 0), "");
  EXPECT_THAT(reason(so3_exp(Vector3d(0, 0, 1)), 0.035),
              testing::ContainsRegex("does not fit the images: its axes are 5[5-9] deg off, its "
                                     "clock is .3[0-9] ms off"));
}

TEST(GyroscopeFit, NamesRatesOfAnotherRecording) {
  Recorded recorded = record({}, 20, 1e-4, 3);
  for (std::size_t k = 0; k < recorded.gyroscope.rates_rad_s.size(); ++k) {
    const double at_s = 1e-9 * static_cast<double>(recorded.gyroscope.timestamps_ns[k] - kBegin_ns);
    // Another rhythm about all axes.
    recorded.gyroscope.rates_rad_s[k] = 1.5 * rate_at(1.37 * at_s + 40);
  }
  const GyroscopeFit fit = fit_gyroscope(recorded.windows, recorded.gyroscope);
  EXPECT_FALSE(fit.ok);
  EXPECT_THAT(why_it_does_not_fit(fit, recorded.gyroscope, 1 / 30.0),
              HasSubstr("the gyroscope does not fit the images: images and gyroscope turn"));
}

TEST(GyroscopeFit, CallsRotationsUndeterminedBeyondARightAngle) {
  GyroscopeFit fit;
  fit.rotation_sigma_deg = {0.5, 120, 2};
  EXPECT_THAT(to_text(fit, {}), HasSubstr("0.50 undetermined 2.00 deg about the camera's axes\n"));
  EXPECT_THAT(
      to_yaml(fit, Camera{}, "desk", {0.01, -0.02, 0.03}),
      HasSubstr("# rotation +- 0.500 undetermined 2.000 deg about the camera's axes, clock"));
}

TEST(GyroscopeFit, WritesTheRecordingsCameraPosition) {
  const GyroscopeFit fit;
  const std::string known = to_yaml(fit, Camera{}, "desk", {0.01, -0.02, 0.03});
  EXPECT_THAT(known, HasSubstr("# position of the camera from the recording\n"));
  EXPECT_THAT(known, HasSubstr("0.000000000, -0.02], [0"));
  EXPECT_THAT(to_yaml(fit, Camera{}, "desk", Eigen::Vector3d::Zero()),
              HasSubstr("# position of the camera unknown: 0\n"));
}

}  // namespace
}  // namespace gpo::test
