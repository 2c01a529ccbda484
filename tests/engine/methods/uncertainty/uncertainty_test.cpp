// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/uncertainty/uncertainty.h"

#include "engine/diagnosis/diagnosis.h"
#include "engine/methods/methods.h"
#include "engine/methods/uncertainty/information.h"
#include "engine/window/window.h"
#include "tests/engine/methods/method_cases.h"
#include "tests/engine/simulated_window.h"

#include <array>
#include <random>
#include <string>

#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using Eigen::Vector3d;

/// Returns the squared error in units of its covariance, within the covariance's range.
double normalized_square(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  return error.dot(covariance.completeOrthogonalDecomposition().solve(error));
}

/// Compares normalized squares of many windows with the chi-square distribution: the mean of n
/// values with d degrees of freedom has the standard deviation sqrt(2 d / n).
struct ChiSquare {
  int freedom;
  double sum = 0;
  int count = 0, beyond_95 = 0;

  void add(double value) {
    constexpr std::array kQuantile95{3.841, 5.991, 7.815};
    sum += value;
    ++count;
    beyond_95 += value > kQuantile95[freedom - 1] ? 1 : 0;
  }
  void expect(double slack = 1) const {
    const double mean = sum / count;
    EXPECT_NEAR(mean, freedom, slack * 4 * std::sqrt(2.0 * freedom / count)) << count << " windows";
    EXPECT_NEAR(beyond_95, 0.05 * count, 4 * std::sqrt(0.05 * 0.95 * count));
  }
};

double center_square(const Simulation& truth, const Initialization& result, std::size_t frame) {
  return normalized_square(result.cameras[frame].p_wc - truth.cameras[frame].p_wc,
                           result.uncertainty->center_covariances[frame]);
}

/// Normalized errors of the normal and of the last camera's center.
struct NormalAndCenter {
  ChiSquare normal{2};
  ChiSquare center{3};

  void add(const Simulation& truth, const Initialization& result) {
    normal.add(normalized_square(result.plane.normal - truth.plane.normal,
                                 result.uncertainty->normal_covariance));
    center.add(center_square(truth, result, truth.cameras.size() - 1));
  }
  void expect() const {
    normal.expect();
    center.expect();
  }
};

Motion motion_of_seed(std::uint64_t seed) {
  return std::array{Motion::orbit, Motion::wander, Motion::arc}[seed % 3];
}

/// Simulates a window whose bias is drawn from its prior, and its clock with this deviation.
Simulation drawn_window(Motion motion, RotationModel model, std::uint64_t seed, double late_s = 0) {
  SimulationOptions options{.motion = motion, .seed = seed};
  if (model == RotationModel::bias) {
    std::mt19937_64 random(seed + 77);
    std::normal_distribution<double> gauss(0, 0.01);
    options.gyro_bias_rad_s = Vector3d(gauss(random), gauss(random), gauss(random)).norm();
    options.gyro_offset_s = 100 * late_s * gauss(random);
  }
  Simulation truth = simulate_fitted(options);
  truth.window.rotations = model;
  return truth;
}

Initialization solved_by(const char* method,
                         const Window& window,
                         const MethodOptions& options = {}) {
  const Method& row = find_method(method);
  Initialization result = assessed(row, window, row.initialize(window, options, {}));
  EXPECT_TRUE(result.ok) << result.reason;
  return result;
}

class NormalizedErrors : public testing::TestWithParam<RotationModel> {};

TEST_P(NormalizedErrors, FollowChiSquareDistribution) {
  NormalAndCenter errors;
  ChiSquare ratio{1}, bias{3}, clock{1};
  for (std::uint64_t seed = 1; seed <= 240; ++seed) {
    const Simulation truth = drawn_window(motion_of_seed(seed), GetParam(), seed, 0.01);
    const Initialization result = solved_by("gpo_joint", truth.window);
    ASSERT_TRUE(result.ok);
    const Uncertainty& u = *result.uncertainty;
    EXPECT_EQ(u.rotations, GetParam());
    EXPECT_NEAR(u.sigma_px, 0.5, 0.05);
    errors.add(truth, result);
    const double ratio_error = result.plane.normal.dot(result.cameras.back().p_wc) -
                               truth.plane.normal.dot(truth.cameras.back().p_wc);
    ratio.add(std::pow(ratio_error / u.distance_ratio_sigmas.back(), 2));
    if (GetParam() != RotationModel::bias) continue;
    bias.add(normalized_square(*result.bias_rad_s - truth.bias_rad_s, *u.bias_covariance));
    clock.add(std::pow((*result.time_offset_s - truth.time_offset_s) / *u.time_offset_sigma_s, 2));
  }
  errors.expect();
  ratio.expect();
  if (GetParam() != RotationModel::bias) return;
  bias.expect(2);  // up to a sixth too small
  clock.expect();
}

INSTANTIATE_TEST_SUITE_P(,
                         NormalizedErrors,
                         testing::Values(RotationModel::known,
                                         RotationModel::bias,
                                         RotationModel::free),
                         [](const auto& each) { return std::string(to_string(each.param)); });

/// A random walk has larger effects than the independent noise per frame that the solver assumes.
TEST(Uncertainty, ModelsGyroscopeNoiseAsRandomWalk) {
  NormalAndCenter errors;
  ChiSquare middle{3};
  for (std::uint64_t seed = 1; seed <= 240; ++seed) {
    const Simulation truth = simulate_fitted({.motion = motion_of_seed(seed),
                                              .noise_px = 0.2,
                                              .gyro_bias_rad_s = 0.01,
                                              .gyro_noise_rad_s = 0.01,
                                              .seed = seed});
    const auto result = solved_by("gpo_joint", truth.window, {.shutter = Shutter::global});
    ASSERT_TRUE(result.ok);
    EXPECT_EQ(result.uncertainty->rotations, RotationModel::bias) << seed;
    errors.add(truth, result);
    middle.add(center_square(truth, result, 15));
  }
  errors.expect();
  middle.expect();
}

TEST(Uncertainty, PropagatesPriorOfHeldBias) {
  NormalAndCenter errors;
  for (std::uint64_t seed = 1; seed <= 240; ++seed) {
    Simulation truth = drawn_window(motion_of_seed(seed), RotationModel::bias, seed);
    truth.window.gyro->time_offset_sigma_s = 0;
    const Initialization result = solved_by("gpo", truth.window);
    ASSERT_TRUE(result.ok);
    EXPECT_EQ(result.uncertainty->rotations, RotationModel::known);
    errors.add(truth, result);
  }
  errors.expect();
}

/// Returns the changes of a window's points for a larger focal length and a larger first radial
/// coefficient: K is 500 px, the principal point is the center of 640 x 480.
std::vector<std::vector<Eigen::Matrix2Xd>> lens_moves(const Window& window,
                                                      double focal_px,
                                                      double radial) {
  std::vector moves(2, window.points_px);
  const Eigen::Vector2d center = window.K.topRightCorner<2, 1>();
  for (int i = 0; i < window.frame_count(); ++i) {
    const Eigen::Array2Xd x = (window.points_px[i].colwise() - center) / window.K(0, 0);
    moves[0][i] = -focal_px * x;
    moves[1][i] = -radial * window.K(0, 0) * (x.rowwise() * x.square().colwise().sum());
  }
  return moves;
}

Window moved_window(Window window, double factor, const std::vector<Eigen::Matrix2Xd>& moves_px) {
  for (int i = 0; i < window.frame_count(); ++i) window.points_px[i] += factor * moves_px[i];
  return window;
}

const MethodOptions kSquared = {.loss = Loss::squared};

// Compares the covariances with the changes of normal and centers for a wrong lens.
TEST(Uncertainty, PropagatesLensErrors) {
  for (const RotationModel model :
       {RotationModel::known, RotationModel::bias, RotationModel::free}) {
    const Simulation truth = drawn_window(Motion::wander, model, 5);
    const auto moves = lens_moves(truth.window, 1e-2, 1e-5);
    for (int k = 0; k < 2; ++k) {
      const auto solved = [&](double sign) {
        return find_method("gpo_joint")
            .initialize(moved_window(truth.window, sign, moves[k]), kSquared, {});
      };
      Window window = truth.window;
      const auto plain = solved_by("gpo_joint", window, kSquared);
      window.lens_moves_px = {moves[k]};
      const auto with_lens = solved_by("gpo_joint", window, kSquared);
      ASSERT_TRUE(plain.uncertainty && with_lens.uncertainty->lens_sigma_deg);
      EXPECT_FALSE(plain.uncertainty->lens_sigma_deg);
      const Initialization more = solved(1), less = solved(-1);
      const auto expect_outer = [&](const Vector3d& moved, const Eigen::Matrix3d& added) {
        const Eigen::Matrix3d expected = moved * moved.transpose();
        EXPECT_LT((added - expected).norm(), 0.05 * expected.norm())
            << "parameter " << k << ", rotations " << to_string(model);
      };
      expect_outer((more.plane.normal - less.plane.normal) / 2,
                   with_lens.uncertainty->normal_covariance - plain.uncertainty->normal_covariance);
      expect_outer((more.cameras.back().p_wc - less.cameras.back().p_wc) / 2,
                   with_lens.uncertainty->center_covariances.back() -
                       plain.uncertainty->center_covariances.back());
    }
  }
}

// With an exact lens the means would be 78 and 46; much larger lens errors exceed the first order.
TEST(Uncertainty, FollowsChiSquareDistributionForUncertainLens) {
  NormalAndCenter errors;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    const Simulation truth = drawn_window(motion_of_seed(seed), RotationModel::known, seed);
    Window window = truth.window;
    std::mt19937_64 random(seed);
    const auto moves = lens_moves(truth.window, 1.5, 0.0006);
    for (const auto& of_parameter : moves)
      window = moved_window(window, std::normal_distribution<double>()(random), of_parameter);
    window.lens_moves_px = moves;
    const Initialization result = solved_by("gpo_joint", window, kSquared);
    ASSERT_TRUE(result.ok);
    errors.add(truth, result);
  }
  errors.expect();
}

/// Moves the points of all frames by a smooth random field of up to about `most_px`, like an error
/// of the lens model.
void bend_images(Window& window, double most_px, std::uint64_t seed) {
  std::mt19937_64 random(seed + 1234);
  std::normal_distribution<double> gauss;
  const Eigen::Matrix<double, 2, 6> field =
      Eigen::Matrix<double, 2, 6>::NullaryExpr([&] { return most_px / 4 * gauss(random); });
  for (Eigen::Matrix2Xd& points : window.points_px)
    for (int j = 0; j < points.cols(); ++j) {
      const double x = (points(0, j) - 320) / 240;
      const double y = (points(1, j) - 240) / 240;
      Eigen::Matrix<double, 6, 1> terms;
      terms << x * x, x * y, y * y, x * x * x, y * y * y, x * y * y;
      points.col(j) += field * terms;
    }
}

struct Consistency {
  int windows = 0;
  int by_neighbors = 0;  ///< windows in which neighbors' and bend's parts are the largest
  int beyond_four = 0;   ///< errors above four standard deviations
  double squares = 0;
};

Consistency consistency_of_windows(double bent_by_px, ErrorModel error = ErrorModel::transfer) {
  Consistency all;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    Simulation truth = simulate({.motion = motion_of_seed(seed), .noise_px = 0.1, .seed = seed});
    bend_images(truth.window, bent_by_px, seed);
    truth = with_fitted_homographies(truth);
    truth.window.rotations = RotationModel::free;
    const Initialization result = resampled_by("gpo_joint", truth.window, {.error = error});
    if (!result.ok) continue;
    const Uncertainty& u = *result.uncertainty;
    const double sigmas = angle_deg(result.plane.normal, truth.plane.normal) / u.normal_sigma_deg;
    ++all.windows;
    const double half = u.normal_sigma_deg * std::sqrt(0.5);
    const double shared =
        std::hypot(u.neighbors_sigma_deg.value_or(0), u.bend_sigma_deg.value_or(0));
    all.by_neighbors += shared > half ? 1 : 0;
    all.beyond_four += sigmas > 4 ? 1 : 0;
    all.squares += sigmas * sigmas;
  }
  return all;
}

TEST(Uncertainty, IncludesErrorsThatNeighborsShare) {
  const Consistency bent = consistency_of_windows(1);
  ASSERT_GT(bent.windows, 100);
  EXPECT_GT(bent.by_neighbors, bent.windows / 2);
  EXPECT_LT(bent.beyond_four, bent.windows / 10);
}

/// A false rolling shutter leads to the joint model, which takes the bend for a lens residual.
TEST(Uncertainty, IncludesSmoothErrorsOfTheImageByDefault) {
  const Consistency bent = consistency_of_windows(1, ErrorModel::automatic);
  ASSERT_GT(bent.windows, 100);
  EXPECT_LT(bent.beyond_four, bent.windows / 10);
}

TEST(Uncertainty, SeldomFindsSharedErrorsInNoise) {
  const Consistency noise = consistency_of_windows(0);
  ASSERT_GT(noise.windows, 110);
  EXPECT_LT(noise.by_neighbors, 0.12 * noise.windows);
  EXPECT_NEAR(noise.squares / noise.windows, 1, 0.3);
}

TEST(Uncertainty, MatchesBoundForKnownRotations) {
  const Simulation truth = simulate({.motion = Motion::orbit});
  const auto u = uncertainty_of(truth.window, truth.plane, truth.cameras, RotationModel::known);
  ASSERT_TRUE(u);
  EXPECT_NEAR(*u->bound_known_rotations_deg,
              *normal_bound_deg(truth.window, truth.plane, truth.cameras, u->sigma_px),
              1e-9);
  EXPECT_NEAR(u->normal_sigma_deg / *u->bound_known_rotations_deg, 1, 0.2);
  EXPECT_EQ(u->tracks, truth.window.inlier_count(0));
  EXPECT_FALSE(u->bound_unknown_bias_deg);
}

TEST(Uncertainty, GrowsWithUnknowns) {
  const Simulation truth =
      simulate({.motion = Motion::wander, .gyro_bias_rad_s = 0.002, .seed = 3});
  const Initialization held = find_method("gpo").initialize(truth.window, {}, {});
  const auto sigma = [&](RotationModel model) {
    const bool holds = model == RotationModel::known;
    const auto& cameras = holds ? held.cameras : truth.cameras;
    return uncertainty_of(truth.window, holds ? held.plane : truth.plane, cameras, model)
        ->normal_sigma_deg;
  };
  const auto u = uncertainty_of(truth.window, truth.plane, truth.cameras, RotationModel::bias);
  EXPECT_LT(*u->bound_known_rotations_deg, sigma(RotationModel::bias));
  EXPECT_LT(sigma(RotationModel::bias), sigma(RotationModel::known));  // held at a wrong value
  EXPECT_LT(sigma(RotationModel::bias), sigma(RotationModel::free));
}

TEST(Uncertainty, IsEmptyForUndeterminedPlane) {
  const Simulation truth = simulate({.motion = Motion::rotation_only});
  EXPECT_FALSE(uncertainty_of(truth.window, truth.plane, truth.cameras, RotationModel::known));
}

TEST(JointCenters, ContainCovariancesOfCentersAndBias) {
  const Simulation truth = simulate_fitted({.motion = Motion::wander,
                                            .frames = 20,
                                            .gyro_bias_rad_s = 0,
                                            .gyro_noise_rad_s = 0.002,
                                            .seed = 3});
  for (const RotationModel rotations :
       {RotationModel::known, RotationModel::bias, RotationModel::free}) {
    const auto u = uncertainty_of(truth.window, truth.plane, truth.cameras, rotations);
    ASSERT_TRUE(u);
    const Eigen::MatrixXd& all = u->joint_covariance;
    EXPECT_EQ(u->joint_bias_rows, rotations == RotationModel::free ? 0 : 4);
    ASSERT_EQ(all.rows(), 3 * 19 + u->joint_bias_rows + 2);
    for (int i = 1; i < 20; ++i) {
      const Eigen::Matrix3d& one = u->center_covariances[i];
      EXPECT_LT((all.block<3, 3>(3 * i - 3, 3 * i - 3) - one).norm(), 1e-6 * one.norm()) << i;
    }
    EXPECT_LT((all - all.transpose()).norm(), 1e-12 * all.norm());
    if (u->bias_covariance) {
      EXPECT_LT((all.block<3, 3>(57, 57) - *u->bias_covariance).norm(),
                1e-6 * u->bias_covariance->norm());
    }
    // Neighboring centers share the errors of normal and bias, so that their difference is more
    // accurate than either, unless each frame has a rotation of its own.
    const double last = all.block<3, 3>(54, 54).trace();
    const double between =
        last + all.block<3, 3>(51, 51).trace() - 2 * all.block<3, 3>(51, 54).trace();
    if (rotations != RotationModel::free) {
      EXPECT_LT(between, last);
    }
    EXPECT_GT(between, 0);
  }
}

/// The sum over 40 tracks alone has no more than 40 of its 87 dimensions.
TEST(JointCenters, HaveErrorsOfTheirInverseWithFewTracks) {
  constexpr int kWindows = 24;
  for (const char* method : {"gpo_joint", "gpo"}) {
    for (const int points : {40, 150}) {
      double sum = 0;
      for (std::uint64_t seed = 1; seed <= kWindows; ++seed) {
        Simulation truth = simulate_fitted({.motion = motion_of_seed(seed),
                                            .points = points,
                                            .gyro_bias_rad_s = 0.005,
                                            .seed = seed});
        truth.window.rotations = RotationModel::bias;
        const Initialization result = solved_by(method, truth.window);
        const Eigen::Index rows = 3 * (std::ssize(truth.cameras) - 1);
        Eigen::VectorXd error(rows);
        for (Eigen::Index i = 0; i < rows / 3; ++i)
          error.segment<3>(3 * i) = result.cameras[i + 1].p_wc - truth.cameras[i + 1].p_wc;
        const auto covariance = result.uncertainty->joint_covariance.topLeftCorner(rows, rows);
        sum += error.dot(covariance.llt().solve(error)) / static_cast<double>(rows);
      }
      EXPECT_GT(sum / kWindows, 0.6) << method << ' ' << points;
      EXPECT_LT(sum / kWindows, 1.7) << method << ' ' << points;
    }
  }
}

}  // namespace
}  // namespace gpo::test
