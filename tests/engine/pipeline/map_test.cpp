// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/map.h"

#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"
#include "tests/engine/pipeline/simulated_frames.h"
#include "tests/engine/test_folder.h"

#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST(Map, GivesPointsAndInliersByTheIdsOfTheCaller) {
  const auto simulation = simulate({.frames = 12, .off_plane = 0.2});
  std::vector<Frame> frames = frames_of(simulation.window);
  for (Frame& frame : frames)
    for (std::int64_t& id : frame.ids) id = 7000 + 3 * id;
  const WindowResult result = initialize(camera_of(simulation.window), frames);
  ASSERT_TRUE(result.initialization.ok) << result.initialization.reason;
  const auto points = points_by_id(result);
  EXPECT_EQ(points.size(), result.initialization.points.size());
  const auto inliers = inlier_ids(result, 11);
  EXPECT_GT(inliers.size(), 100U);
  for (const std::int64_t id : inliers) {
    const auto track = static_cast<std::size_t>((id - 7000) / 3);
    EXPECT_TRUE(simulation.on_plane[track]) << id;
    ASSERT_TRUE(points.contains(id)) << id;
    EXPECT_LT(std::abs(simulation.plane.normal.dot(points.at(id)) + 1), 0.02) << id;
  }
}

/// Returns the errors of the cameras but the first, in the order of the prior's rows.
VectorXd pose_errors(const PosePrior& prior, const std::vector<Pose>& truth) {
  VectorXd errors(prior.covariance.rows());
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Pose& pose = prior.cameras[i];
    errors.segment<6>(6 * (static_cast<Eigen::Index>(i) - 1))
        << so3_log(pose.R_wc.transpose() * truth[i].R_wc),
        truth[i].p_wc - pose.p_wc;
  }
  return errors;
}

/// Squared errors over claimed variances, as medians over the windows that were solved: 1 expected.
struct MonteCarlo {
  int solved = 0;
  double of_rows = 0;
  double of_sums = 0;  ///< random sums of all rows: these depend on the correlations
};

MonteCarlo monte_carlo(SimulationOptions options, int windows) {
  constexpr int kSums = 40;
  constexpr double kMedianOfSquares = 0.4549;  // chi-square of one number
  std::vector<double> of_rows, of_sums;
  for (int k = 1; k <= windows; ++k) {
    options.seed = k;
    const Simulation simulation = simulate(options);
    std::optional<Gyroscope> gyroscope;
    if (options.gyro_bias_rad_s) gyroscope = simulated_gyroscope(options);
    const auto prior = pose_prior(initialize(camera_of(simulation.window),
                                             frames_of(simulation.window),
                                             gyroscope ? &*gyroscope : nullptr,
                                             {.method_options = {.shutter = Shutter::global}}));
    if (!prior) continue;
    const VectorXd sigma = prior->covariance.diagonal().cwiseSqrt();
    const VectorXd e = pose_errors(*prior, simulation.cameras).cwiseQuotient(sigma);
    const MatrixXd C =
        sigma.cwiseInverse().asDiagonal() * prior->covariance * sigma.cwiseInverse().asDiagonal();
    std::mt19937 random(3);
    std::normal_distribution<double> gauss;
    const MatrixXd w = MatrixXd::NullaryExpr(e.size(), kSums, [&] { return gauss(random); });
    of_rows.push_back(e.squaredNorm() / static_cast<double>(e.size()));
    for (int s = 0; s < kSums; ++s)
      of_sums.push_back(std::pow(w.col(s).dot(e), 2) / w.col(s).dot(C * w.col(s)));
  }
  return {static_cast<int>(of_rows.size()), median(of_rows), median(of_sums) / kMedianOfSquares};
}

TEST(PosePrior, HasTheCovarianceOfRotationsAndCentersOverManyWindows) {
  constexpr int kWindows = 60;
  const SimulationOptions free = noisy(Motion::wander, 1);
  SimulationOptions gyro = free;
  gyro.gyro_bias_rad_s = 0.01;
  gyro.gyro_noise_rad_s = 0.002;
  for (const SimulationOptions& options : {free, gyro}) {
    const MonteCarlo found = monte_carlo(options, kWindows);
    EXPECT_GE(found.solved, 0.9 * kWindows);
    for (const double each : {found.of_rows, found.of_sums}) {
      EXPECT_GT(each, 0.4);
      EXPECT_LT(each, 1.5);
    }
    RecordProperty(options.gyro_bias_rad_s ? "gyro" : "free",
                   fmt::format("{} {:.2f} {:.2f}", found.solved, found.of_rows, found.of_sums));
  }
}

TEST(PosePrior, NamesItsRowsAndIsAbsentWithoutAJointCovariance) {
  const auto simulation = simulate({.frames = 8, .reference_noise_px = 0.5});
  const Camera camera = camera_of(simulation.window);
  const std::vector<Frame> frames = frames_of(simulation.window);
  const auto prior = pose_prior(initialize(camera, frames));
  ASSERT_TRUE(prior);
  ASSERT_EQ(prior->rows.size(), 42U);
  EXPECT_EQ(prior->covariance.rows(), 42);
  EXPECT_EQ(prior->rows[0], "camera 1 rotation x");
  EXPECT_EQ(prior->rows[5], "camera 1 center z");
  EXPECT_EQ(prior->rows[41], "camera 7 center z");
  EXPECT_FALSE(pose_prior(initialize(camera, frames, nullptr, {.method = "gpo"})));
}

/// Returns exact tracks with noise of 0.3 px, and of 0.6 px on every other track, with or without
/// these standard deviations.
std::vector<Frame> unequal_frames(const Simulation& exact, std::uint64_t seed, bool stated) {
  std::vector<Frame> frames = frames_of(exact.window);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss;
  for (Frame& frame : frames) {
    VectorXd sigma_px(std::ssize(frame.ids));
    for (Eigen::Index k = 0; k < sigma_px.size(); ++k) {
      sigma_px[k] = frame.ids[k] % 2 == 0 ? 0.3 : 0.6;
      frame.raw_px.col(k) += sigma_px[k] * Eigen::Vector2d(gauss(random), gauss(random));
    }
    if (stated) frame.sigma_px = sigma_px;
  }
  for (int i = 0; i < exact.window.frame_count(); ++i) frames[i].R_wc = exact.window.R_wc[i];
  return frames;
}

TEST(SigmaOfObservations, ImprovesTheNormalWithAnHonestUncertainty) {
  constexpr int kWindows = 60;
  double with_squares = 0, without_squares = 0, normalized_squares = 0;
  for (std::uint64_t seed = 1; seed <= kWindows; ++seed) {
    const auto exact = simulate({.motion = Motion::orbit, .frames = 12, .noise_px = 0});
    const auto error_deg = [&](const WindowResult& result) {
      return angle_deg(result.initialization.plane.normal, exact.plane.normal);
    };
    const auto result = [&](bool stated) {
      return initialize(camera_of(exact.window), unequal_frames(exact, seed, stated));
    };
    const WindowResult with = result(true), without = result(false);
    ASSERT_TRUE(with.initialization.ok) << with.initialization.reason;
    with_squares += std::pow(error_deg(with), 2);
    without_squares += std::pow(error_deg(without), 2);
    normalized_squares +=
        std::pow(error_deg(with) / with.initialization.uncertainty->normal_sigma_deg, 2);
    EXPECT_GT(inlier_ids(with, 11).size() + 5, inlier_ids(without, 11).size());
  }
  EXPECT_LT(with_squares, 0.85 * without_squares);
  EXPECT_GT(normalized_squares / kWindows, 0.4);
  EXPECT_LT(normalized_squares / kWindows, 1.5);
}

TEST(SigmaOfObservations, ChangesNothingIfAllAreEqual) {
  const auto simulation = simulate({.frames = 10, .reference_noise_px = 0.5});
  std::vector<Frame> frames = frames_of(simulation.window);
  const Camera camera = camera_of(simulation.window);
  const WindowResult plain = initialize(camera, frames);
  for (Frame& frame : frames) frame.sigma_px = VectorXd::Constant(std::ssize(frame.ids), 0.7);
  expect_same(plain.initialization, initialize(camera, frames).initialization);
}

TEST(SigmaOfObservations, IsRejectedIfItIsNotPositiveOrMissing) {
  const auto simulation = simulate({.frames = 4});
  std::vector<Frame> frames = frames_of(simulation.window);
  const auto error = [&] {
    return error_of([&] { initialize(camera_of(simulation.window), frames); });
  };
  frames[1].sigma_px = VectorXd::Ones(3);
  EXPECT_EQ(error(), "frame 1: 3 sigma_px and 150 ids, expected equal counts or none");
  frames[1].sigma_px = VectorXd::Zero(150);
  EXPECT_EQ(error(), "frame 1: a sigma_px is not a finite number above 0");
  frames[1].sigma_px = VectorXd::Ones(150);
  EXPECT_EQ(error(), "frame 1: expected sigma_px of all frames or of none");
}

}  // namespace
}  // namespace gpo::test
