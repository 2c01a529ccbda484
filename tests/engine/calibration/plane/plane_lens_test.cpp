// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/plane/plane_lens.h"

#include "engine/calibration/plane/plane_selection.h"
#include "tests/engine/calibration/plane/simulated_views.h"

#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using testing::HasSubstr;

/// As a recording without any calibration gets it.
Camera guess_of(const Camera& camera, double k1 = 0) {
  return {camera.width,
          camera.height,
          0.9 * camera.width,
          0.9 * camera.width,
          0.5 * (camera.width - 1),
          0.5 * (camera.height - 1),
          Distortion::radial_tangential,
          {k1, 0, 0, 0}};
}

/// Errors in standard deviations.
LensVector normalized_errors(const PlaneLens& found, const Camera& truth) {
  return (found.lens - lens_of(truth)).cwiseQuotient(found.sigma);
}

/// How a gyroscope with a bias that nobody knows saw the pictures' cameras turn.
GyroRotations turns_of(const SimulatedScene& scene, const Eigen::Vector3d& bias_rad_s) {
  GyroRotations gyro;
  constexpr double kStep_s = 4.0 / 30;
  for (std::size_t i = 1; i < scene.poses.size(); ++i) {
    const Eigen::Matrix3d R = scene.poses[i - 1].R_wc.transpose() * scene.poses[i].R_wc;
    gyro.rotations.push_back({scene.plane.views[i - 1].frame,
                          scene.plane.views[i].frame,
                          R * so3_exp(kStep_s * -bias_rad_s),
                          kStep_s * Eigen::Matrix3d::Identity(),
                          2e-4});
  }
  return gyro;
}

/// A lens of the pictures' width, and what the pictures' own bend is guessed to be.
struct UnlikeLens {
  const char* name;
  double focal;  ///< [widths]
  double aspect;
  double cx;  ///< from the middle [widths]
  double cy;
  double k1;
  double k2;
  double k1_of_guess;
};

Camera camera_of(const UnlikeLens& lens) {
  return {640,
          480,
          640 * lens.focal,
          640 * lens.focal * lens.aspect,
          319.5 + 640 * lens.cx,
          239.5 + 640 * lens.cy,
          Distortion::radial_tangential,
          {lens.k1, lens.k2, 5e-4, -4e-4}};
}

constexpr int kSeedsALens = 5;

/// What the errors of some seeds are, in standard deviations.
struct Calibrated {
  LensVector squares = LensVector::Zero();  ///< mean
  int within_three = 0;                     ///< of f
};

Calibrated calibrated(const UnlikeLens& lens) {
  Calibrated all;
  for (std::uint64_t seed = 1; seed <= kSeedsALens; ++seed) {
    const SimulatedViews options{.camera = camera_of(lens),
                                  .points = 80,
                                  .images = 20,
                                  .half_m = 0.75 / lens.focal,
                                  .moves_m = 0.25 / lens.focal,
                                  .unevenness_m = 0.002,
                                  .outliers = 0.02};
    const auto found = lens_from_planes(
        {simulate_views(options, seed).plane}, {}, guess_of(options.camera, lens.k1_of_guess));
    EXPECT_TRUE(found.ok) << lens.name << " " << seed << ": " << found.reason;
    if (!found.ok) continue;
    const LensVector errors = normalized_errors(found, options.camera);
    all.squares += errors.cwiseAbs2() / kSeedsALens;
    all.within_three += std::abs(errors[0]) < 3 ? 1 : 0;
  }
  return all;
}

TEST(PlaneLens, FindsUnlikeLensesWithinStandardDeviationsThatTellTheErrors) {
  const std::vector<UnlikeLens> lenses = {{"usual", 0.875, 1.005, 0.008, -0.01, 0.05, -0.1, 0},
                                          {"wide", 0.6, 1.002, 0.02, -0.015, -0.3, 0.08, -0.6},
                                          {"long", 1.4, 0.995, -0.03, 0.015, 0.1, -0.2, 0},
                                          {"off the middle", 1, 1, 0.03, 0.03, 0, 0, 0},
                                          {"bent", 0.8, 1, -0.01, 0.02, -0.15, 0.05, -0.2}};
  LensVector squares = LensVector::Zero();
  int within_three = 0;
  for (const UnlikeLens& lens : lenses) {
    const Calibrated some = calibrated(lens);
    within_three += some.within_three;
    squares += some.squares / static_cast<double>(lenses.size());
  }
  EXPECT_GE(within_three, 23);  // of 25: nine of ten
  // 99.9 % of a chi-square of 25 numbers; ten seeds a lens have a mean of 1.35.
  EXPECT_THAT(squares[0], testing::AllOf(testing::Gt(0.4), testing::Lt(2.1)));
  for (int k = 1; k < 6; ++k) {
    EXPECT_THAT(squares[k], testing::AllOf(testing::Gt(0.35), testing::Lt(2.5))) << kLensNames[k];
  }
}

TEST(PlaneLens, ARollingShutterIsNoBendOfTheLens) {
  double squares = 0;
  double unknown_squares = 0;
  constexpr int kSeeds = 3;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const SimulatedViews options{.points = 120, .images = 24, .half_m = 0.9, .readout = 0.7};
    auto scene = simulate_views(options, seed);
    LensVector truth = lens_of(options.camera);
    truth[kReadout] = options.readout;
    const auto found = lens_from_planes({scene.plane}, {}, guess_of(options.camera));
    ASSERT_TRUE(found.ok) << found.reason;
    const LensVector errors = found.lens - truth;
    EXPECT_LT(errors.cwiseQuotient(found.sigma).cwiseAbs().maxCoeff(), 4) << seed;
    EXPECT_NEAR(found.lens[kReadout], options.readout, 0.02) << seed;
    squares += errors[0] * errors[0];
    for (PlaneView& view : scene.plane.views) view.flow_px.setZero();
    const auto unknown = lens_from_planes({scene.plane}, {}, guess_of(options.camera));
    unknown_squares += std::pow(unknown.lens[0] - truth[0], 2);
    EXPECT_TRUE(unknown.prior_only[kReadout]);
  }
  EXPECT_LT(squares, 0.05 * unknown_squares);
}

TEST(PlaneLens, AnUnevenPlaneIsNoNoiseOfItsPoints) {
  // Waves of 4 mm, seen from 1 m, move points by a pixel as the camera goes around them.
  const SimulatedViews options{
      .points = 150, .images = 24, .half_m = 0.9, .unevenness_m = 0.004};
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto scene = simulate_views(options, seed);
    const auto found = lens_from_planes({scene.plane}, {}, guess_of(options.camera));
    ASSERT_TRUE(found.ok) << found.reason;
    EXPECT_LT(found.rms_px, 1.2 * std::numbers::sqrt2 * options.noise_px) << seed;
    EXPECT_LT(std::abs(normalized_errors(found, options.camera)[0]), 3.5) << seed;
  }
}

TEST(PlaneLens, NothingLeftIsNotLookedAtAnyFarther) {
  const std::vector<ObservedPlane> planes{{3, {{0, {}, Eigen::Matrix2Xd(2, 0)}}}};
  std::vector<int> left_out;
  const auto kept = without_far(planes, {{Eigen::VectorXd(0)}}, 1, left_out);
  EXPECT_EQ(observation_count(kept), 0);
  EXPECT_THAT(left_out, testing::IsEmpty());
}

TEST(PlaneLens, CountsWhatIsWrongWithAPointOnce) {
  // Half a pixel that is the same in all pictures of a point leaves hardly a trace in the errors.
  double squares = 0;
  double own_squares = 0;
  constexpr int kSeeds = 6;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const SimulatedViews options{
        .points = 150, .images = 30, .noise_px = 0.1, .track_noise_px = 0.6};
    const auto scene = simulate_views(options, seed);
    const auto found = lens_from_planes({scene.plane}, {}, guess_of(options.camera));
    ASSERT_TRUE(found.ok) << found.reason;
    squares += std::pow(normalized_errors(found, options.camera)[0], 2) / kSeeds;
    own_squares += found.sigma[0] / kSeeds;
  }
  EXPECT_LT(std::sqrt(squares), 1.8);
  EXPECT_LT(own_squares, 0.01);
}

TEST(PlaneLens, RefusesACameraThatKeepsItsTiltAndSaysWhy) {
  const auto scene = simulate_views({.points = 150, .images = 30, .slant_deg = 2}, 1);
  const auto found = lens_from_planes({scene.plane}, {}, guess_of(SimulatedViews{}.camera));
  EXPECT_FALSE(found.ok);
  EXPECT_THAT(found.reason, HasSubstr("keeps its tilt to the plane"));
  EXPECT_LT(found.tilt_deg, 8);
}

TEST(PlaneLens, RefusesImagesThatAreTooFew) {
  const auto scene = simulate_views({.images = 4}, 1);
  const auto found = lens_from_planes({scene.plane}, {}, guess_of(SimulatedViews{}.camera));
  EXPECT_FALSE(found.ok);
  EXPECT_EQ(found.reason, "a plane is seen in 4 pictures; at least 6 are needed");
}

TEST(PlaneLens, SaysWhatOnlyThePriorTells) {
  const auto upright = simulate_views({.points = 150, .images = 30, .slant_deg = 1}, 2);
  const auto slanted = simulate_views({.points = 150, .images = 30}, 2);
  const Camera guess = guess_of(SimulatedViews{}.camera);
  const auto vague = lens_from_planes({upright.plane}, {}, guess);
  const auto sure = lens_from_planes({slanted.plane}, {}, guess);
  EXPECT_TRUE(vague.prior_only[0]) << vague.sigma.transpose();
  EXPECT_FALSE(sure.prior_only[0]) << sure.sigma.transpose();
  EXPECT_FALSE(sure.prior_only[4]) << sure.sigma.transpose();
}

TEST(PlaneLens, AGyroscopeOfUnknownBiasMakesTheFocalLengthSurer) {
  const SimulatedViews options{.points = 150, .images = 30, .slant_deg = 3, .kept_tilt_deg = 30};
  double sigma_without = 0;
  double sigma_with = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto scene = simulate_views(options, seed);
    const Camera guess = guess_of(options.camera);
    const auto without = lens_from_planes({scene.plane}, {}, guess);
    const auto with = lens_from_planes({scene.plane}, turns_of(scene, {0.05, -0.03, 0.02}), guess);
    ASSERT_TRUE(with.ok) << with.reason;
    sigma_without += without.sigma[0];
    sigma_with += with.sigma[0];
    EXPECT_LT(std::abs(normalized_errors(with, options.camera)[0]), 3.5) << seed;
  }
  EXPECT_LT(sigma_with, 0.9 * sigma_without);
}

TEST(PlaneLens, SeveralPlanesShareTheLens) {
  const SimulatedViews options{.points = 150, .images = 12};
  std::vector<ObservedPlane> planes;
  for (const std::uint64_t seed : {1, 2, 3}) planes.push_back(simulate_views(options, seed).plane);
  const auto found = lens_from_planes(planes, {}, guess_of(options.camera));
  ASSERT_TRUE(found.ok) << found.reason;
  EXPECT_EQ(found.views, 36);
  EXPECT_LT(normalized_errors(found, options.camera).cwiseAbs().maxCoeff(), 4);
}

TEST(PlaneLens, LeavesOutImagesThatDisagreeAndNamesThem) {
  auto scene = simulate_views({.points = 150, .images = 30}, 1);
  PlaneView& bad = scene.plane.views[11];
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 4);
  for (auto column : bad.raw_px.colwise()) column += Eigen::Vector2d(noise(random), noise(random));
  const auto found = lens_from_planes({scene.plane}, {}, guess_of(SimulatedViews{}.camera));
  ASSERT_TRUE(found.ok) << found.reason;
  EXPECT_THAT(found.left_out, testing::ElementsAre(bad.frame));
}

TEST(PlaneLens, EndsWhereItIsStopped) {
  std::stop_source stop;
  stop.request_stop();
  const auto scene = simulate_views({}, 1);
  const auto found = lens_from_planes(
      {scene.plane}, {}, guess_of(SimulatedViews{}.camera), {}, {}, stop.get_token());
  EXPECT_TRUE(found.stopped);
  EXPECT_FALSE(found.ok);
}

}  // namespace
}  // namespace gpo
