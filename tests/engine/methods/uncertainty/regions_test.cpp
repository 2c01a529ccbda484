// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/uncertainty/regions.h"

#include "engine/diagnosis/diagnosis.h"
#include "engine/geometry/homography.h"
#include "engine/geometry/statistics.h"
#include "engine/methods/methods.h"
#include "engine/methods/plane/rolling_shutter.h"
#include "engine/methods/uncertainty/shares.h"
#include "tests/engine/methods/method_cases.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <array>
#include <string>

#include <Eigen/QR>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using Eigen::Vector3d;

double normal_square(const Initialization& result, const Simulation& truth) {
  const Vector3d error = result.plane.normal - truth.plane.normal;
  return error.dot(
      result.uncertainty->normal_covariance.completeOrthogonalDecomposition().solve(error));
}

Simulation noisy_window(std::uint64_t seed,
                        std::optional<double> bias_rad_s = std::nullopt,
                        double late_s = 0,
                        double row_delay_s = 0) {
  constexpr std::array kTried{Motion::orbit, Motion::wander, Motion::arc};
  return simulate_fitted({.motion = kTried[seed % 3],
                          .frames = 20,
                          .points = 120,
                          .gyro_bias_rad_s = bias_rad_s,
                          .gyro_offset_s = late_s,
                          .reference_noise_px = 0.5,
                          .row_delay_s = row_delay_s,
                          .seed = seed});
}

class OwnUncertainty : public testing::TestWithParam<const char*> {};

TEST_P(OwnUncertainty, MatchesTheErrorsOfTheMethod) {
  double squares = 0;
  std::vector<double> sigmas;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Simulation truth = noisy_window(seed);
    const Initialization result = resampled_by(GetParam(), truth.window);
    if (!result.ok) continue;
    ASSERT_TRUE(result.uncertainty && result.uncertainty->own) << seed;
    EXPECT_EQ(result.verdict->normal_sigma_deg,
              normal_sigma_deg(*result.uncertainty, Lens::typical));
    squares += normal_square(result, truth);
    sigmas.push_back(angle_deg(result.plane.normal, truth.plane.normal) /
                     result.uncertainty->normal_sigma_deg);
    ++count;
  }
  ASSERT_GT(count, 35);
  RecordProperty("nees", std::to_string(squares / count));
  RecordProperty("median_sigmas", std::to_string(median(sigmas)));
  EXPECT_GT(squares / count, 0.4);  // no claim is below the noise of the window
  EXPECT_LT(squares / count, 4);
}

INSTANTIATE_TEST_SUITE_P(Methods,
                         OwnUncertainty,
                         testing::Values("closed_form", "dbscan", "pnp", "gpo", "pba"),
                         [](const auto& each) { return std::string(each.param); });

TEST(OwnUncertainty, DiffersBetweenMethodsOnOneWindow) {
  const Window window = noisy_window(4).window;
  const auto sigma_deg = [&](const char* key) {
    return resampled_by(key, window).uncertainty->normal_sigma_deg;
  };
  EXPECT_NE(sigma_deg("gpo"), sigma_deg("closed_form"));
  EXPECT_NE(sigma_deg("dbscan"), sigma_deg("closed_form"));
  EXPECT_NE(sigma_deg("pnp"), sigma_deg("pba"));
}

TEST(OwnUncertainty, JointCovarianceHasTheCovariancesOfTheCenters) {
  const Initialization result = resampled_by("closed_form", noisy_window(2, 0.002).window);
  const Uncertainty& u = *result.uncertainty;
  for (std::size_t i = 1; i < result.cameras.size(); ++i) {
    const auto at = 3 * (static_cast<Eigen::Index>(i) - 1);
    const Eigen::Matrix3d& one = u.center_covariances[i];
    EXPECT_LT((u.joint_covariance.block<3, 3>(at, at) - one).norm(), 1e-6 * one.norm()) << i;
  }
  const double of_normal = u.joint_covariance.bottomRightCorner(2, 2).trace();
  EXPECT_NEAR(of_normal / u.normal_covariance.trace(), 1, 1e-6);
}

TEST(OwnUncertainty, IsMissingForMethodsThatAreNotResampled) {
  Method method = find_method("closed_form");
  method.resampled = false;
  const Window window = noisy_window(1).window;
  const auto run = [&](const Window& w) { return method.initialize(w, {}, {}); };
  EXPECT_FALSE(own_noise(method, window, run(window), run, {}, {}));
  EXPECT_FALSE(assessed(method, window, run(window)).uncertainty->own);
}

TEST(OwnUncertainty, MethodThatFailsWithoutAnyGroupOfTracksIsNotReady) {
  const Method& method = find_method("closed_form");
  const Window window = noisy_window(1).window;
  const Initialization result = method.initialize(window, {}, {});
  EXPECT_EQ(assessed(method, window, result).verdict->readiness, Readiness::ready);
  Initialization doubtful = result;
  const auto fails = [](const Window&) { return failed("too few tracks"); };
  doubtful.own_noise = own_noise(method, window, result, fails, {}, {});
  ASSERT_TRUE(doubtful.own_noise && doubtful.own_noise->unstable);
  doubtful = assessed(method, window, doubtful);
  ASSERT_TRUE(doubtful.ok);
  EXPECT_EQ(doubtful.verdict->readiness, Readiness::weak);
  EXPECT_EQ(doubtful.verdict->reason,
            "without one region of the image the method mostly fails or finds another plane normal");
  EXPECT_FALSE(doubtful.uncertainty->own);
}

/// A bias of 0.003 rad/s tilts the normal of these windows by some tenths of a degree.
TEST(HeldGyroscope, HasBiasBoundedByTheTracksHoweverWideItsPrior) {
  double squares = 0;
  std::vector<double> sigmas;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Simulation truth = noisy_window(seed, 0.003);
    truth.window.gyro->bias_covariance = 0.01 * Eigen::Matrix3d::Identity();
    const Initialization result = resampled_by("gpo", truth.window);
    if (!result.ok) continue;
    squares += normal_square(result, truth);
    sigmas.push_back(angle_deg(result.plane.normal, truth.plane.normal) /
                     result.uncertainty->normal_sigma_deg);
  }
  ASSERT_GT(sigmas.size(), 35);
  EXPECT_LT(squares / static_cast<double>(sigmas.size()), 4);
  EXPECT_GT(median(sigmas), 0.3);
}

/// A clock that is 10 ms late tilts the normal as much.
TEST(HeldGyroscope, HasClockAsLateAsTheTracksTell) {
  std::vector<double> sigmas_deg[2], late_s[2];
  for (const int late : {0, 1}) {
    double squares = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      Simulation truth = noisy_window(seed, 0.0, 0.01 * late);
      truth.window.gyro->bias_covariance = 1e-8 * Eigen::Matrix3d::Identity();
      const Initialization result = resampled_by("gpo", truth.window);
      if (!result.ok) continue;
      squares += normal_square(result, truth);
      sigmas_deg[late].push_back(result.uncertainty->normal_sigma_deg);
      if (result.uncertainty->late_s) late_s[late].push_back(*result.uncertainty->late_s);
    }
    ASSERT_GT(sigmas_deg[late].size(), 35);
    EXPECT_LT(squares / static_cast<double>(sigmas_deg[late].size()), 4) << late;
  }
  EXPECT_GT(median(sigmas_deg[1]), 2 * median(sigmas_deg[0]));
  EXPECT_LE(late_s[0].size(), 2);
  ASSERT_GT(late_s[1].size(), 20);
  EXPECT_NEAR(median(late_s[1]), 0.01, 0.003);
}

class NeglectedShutter : public testing::TestWithParam<const char*> {};

/// 40 us are a readout of 19 ms.
TEST_P(NeglectedShutter, WidensTheUncertaintyByTheRowDelayOfTheTracks) {
  constexpr double kDelay_s = 40e-6;
  std::vector<double> delays_s[2];
  for (const int rolls : {0, 1}) {
    double squares = 0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      const Simulation truth = noisy_window(seed, std::nullopt, 0, rolls * kDelay_s);
      const Initialization result = resampled_by(GetParam(), truth.window);
      if (!result.ok) continue;
      squares += normal_square(result, truth);
      ++count;
      const auto& u = *result.uncertainty;
      if (!u.neglected_row_delay_s) continue;
      EXPECT_TRUE(u.shutter_sigma_deg && *u.shutter_sigma_deg < u.normal_sigma_deg);
      delays_s[rolls].push_back(*u.neglected_row_delay_s);
    }
    ASSERT_GT(count, 35);
    RecordProperty(rolls ? "nees_rolling" : "nees_global", std::to_string(squares / count));
    EXPECT_LT(squares / count, 4) << rolls;
  }
  EXPECT_LE(delays_s[0].size(), 2);
  ASSERT_GT(delays_s[1].size(), 25);
  EXPECT_NEAR(median(delays_s[1]), kDelay_s, 0.25 * kDelay_s);
}

INSTANTIATE_TEST_SUITE_P(Methods,
                         NeglectedShutter,
                         testing::Values("gpo", "pba", "ba"),
                         [](const auto& info) { return std::string(info.param); });

/// `gpo_joint` searches a row delay only if this chi-square is above 5.7.
TEST(RowDelayByTracks, HasTheChiSquareOfChanceWithAGlobalShutterAndALargeOneElse) {
  double of_chance = 0, least_rolling = 1e9;
  constexpr int kSeeds = 40;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    for (const double delay_s : {0.0, 40e-6}) {
      const Window window = simulate_fitted({.motion = Motion::orbit,
                                             .frames = 20,
                                             .points = 120,
                                             .row_delay_s = delay_s,
                                             .seed = seed})
                                .window;
      const Initialization result = resampled_by("gpo", window);
      ASSERT_TRUE(result.ok) << seed;
      const PlaneMotion motion = motion_of(result.plane, result.cameras);
      const PlaneObservations observations = plane_observations(window);
      const auto moved =
          without_rolling_shutter(window, motion, window.rotations, unknown_row_delay(window));
      const auto multiple =
          multiple_of({window, observations, motion}, window.rotations, moved.row_delay_moves_px);
      ASSERT_TRUE(multiple) << seed;
      if (delay_s == 0) of_chance += multiple->chi_square / kSeeds;
      if (delay_s > 0) least_rolling = std::min(least_rolling, multiple->chi_square);
    }
  }
  EXPECT_GT(of_chance, 0.5);
  EXPECT_LT(of_chance, 1.7);
  EXPECT_GT(least_rolling, 5.7);
}

TEST(KnownShutter, WidensTheUncertaintyOfMethodsThatNeglectIt) {
  Simulation truth = noisy_window(1, std::nullopt, 0, 40e-6);
  truth.window.row_delay = RowDelayPrior{40e-6, 1e-6};
  const auto uncertainty = [&] { return resampled_by("pba", truth.window).uncertainty; };
  const auto known = uncertainty();
  ASSERT_TRUE(known && known->neglected_row_delay_s);
  EXPECT_EQ(*known->neglected_row_delay_s, 40e-6);
  truth.window.row_delay = RowDelayPrior{};
  EXPECT_FALSE(uncertainty()->shutter_sigma_deg);
}

TEST(WithoutTracks, HomographiesAreThoseOfTheOtherTracks) {
  const Window window = noisy_window(1).window;
  std::vector<bool> removed(window.track_count(), false);
  for (int j = 10; j < 40; ++j) removed[j] = true;
  const Window less = without_tracks(window, removed);
  EXPECT_EQ(less.track_count(), window.track_count() - 30);
  EXPECT_EQ(less.points_px[3].col(10), window.points_px[3].col(40));
  const std::vector<int> inliers = less.inlier_tracks(3);
  const Eigen::Matrix3d H = refine_homography(
      less.H_i1[3], less.points_px[0](Eigen::all, inliers), less.points_px[3](Eigen::all, inliers));
  EXPECT_LT((less.H_i1[3] - H).norm(), 1e-6);
  EXPECT_GT((less.H_i1[3] - window.H_i1[3]).norm(), 1e-6);
}

}  // namespace
}  // namespace gpo::test
