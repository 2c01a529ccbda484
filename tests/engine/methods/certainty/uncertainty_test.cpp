// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/uncertainty.h"

#include "engine/geometry/plane.h"
#include "engine/methods/certainty/shared_information.h"
#include "engine/methods/initializers.h"
#include "engine/methods/methods.h"
#include "engine/window/window.h"
#include "tests/engine/simulated_window.h"

#include <random>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using Eigen::Vector3d;

/// Error squared in units of its covariance, of what lies in the covariance's range.
double normalized_square(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  return error.dot(covariance.completeOrthogonalDecomposition().solve(error));
}

/// Means of normalized squares over many windows against the chi-square distribution's: the mean of
/// n of them with d degrees of freedom has the standard deviation sqrt(2 d / n).
struct ChiSquare {
  int freedom;
  double sum = 0;
  int count = 0;
  int beyond_95 = 0;

  void add(double value, double quantile_95) {
    sum += value;
    ++count;
    beyond_95 += value > quantile_95 ? 1 : 0;
  }
  void expect(double slack = 1) const {
    const double mean = sum / count;
    EXPECT_NEAR(mean, freedom, slack * 4 * std::sqrt(2.0 * freedom / count)) << count << " windows";
    EXPECT_NEAR(beyond_95, 0.05 * count, 4 * std::sqrt(0.05 * 0.95 * count));
  }
};

constexpr double kQuantile1 = 3.841, kQuantile2 = 5.991, kQuantile3 = 7.815;

/// Those of the normal and of the last camera's center.
void add_errors(const Simulation& truth,
                const Initialization& result,
                ChiSquare& normal,
                ChiSquare& center) {
  const Uncertainty& u = *result.uncertainty;
  normal.add(normalized_square(result.plane.normal - truth.plane.normal, u.normal_covariance),
             kQuantile2);
  const std::size_t last = truth.cameras.size() - 1;
  center.add(normalized_square(result.cameras[last].p_wc - truth.cameras[last].p_wc,
                               u.center_covariances[last]),
             kQuantile3);
}

/// A window whose bias is drawn from its prior, so that the prior tells the truth.
Simulation window_of(Motion motion, RotationModel rotations, std::uint64_t seed) {
  SimulationOptions options{.motion = motion, .seed = seed};
  if (rotations == RotationModel::bias) {
    std::mt19937_64 random(seed + 77);
    std::normal_distribution<double> gauss(0, 0.01);
    options.gyro_bias_rad_s = Vector3d(gauss(random), gauss(random), gauss(random)).norm();
  }
  Simulation truth = with_fitted_homographies(simulate(options));
  truth.window.rotations = rotations;
  return truth;
}

class NormalizedErrors : public testing::TestWithParam<RotationModel> {};

TEST_P(NormalizedErrors, FollowTheChiSquareDistribution) {
  const Method& method = find_method("gpo_joint");
  ChiSquare normal{2}, center{3}, ratio{1}, bias{3};
  for (std::uint64_t seed = 1; seed <= 240; ++seed) {
    const Motion motion = std::array{Motion::orbit, Motion::wander, Motion::arc}[seed % 3];
    const Simulation truth = window_of(motion, GetParam(), seed);
    const Initialization result =
        assessed(method, truth.window, method.initialize(truth.window, {}, {}));
    ASSERT_TRUE(result.ok) << result.reason;
    const Uncertainty& u = *result.uncertainty;
    EXPECT_EQ(u.rotations, GetParam());
    EXPECT_NEAR(u.sigma_px, 0.5, 0.05);
    normal.add(normalized_square(result.plane.normal - truth.plane.normal, u.normal_covariance),
               kQuantile2);
    const std::size_t last = truth.cameras.size() - 1;
    const Vector3d center_error = result.cameras[last].p_wc - truth.cameras[last].p_wc;
    center.add(normalized_square(center_error, u.center_covariances[last]), kQuantile3);
    const double ratio_error = result.plane.normal.dot(result.cameras[last].p_wc) -
                               truth.plane.normal.dot(truth.cameras[last].p_wc);
    ratio.add(std::pow(ratio_error / u.distance_ratio_sigmas[last], 2), kQuantile1);
    if (GetParam() == RotationModel::bias)
      bias.add(normalized_square(*result.bias_rad_s - truth.bias_rad_s, *u.bias_covariance),
               kQuantile3);
  }
  normal.expect();
  center.expect();
  ratio.expect();
  if (GetParam() == RotationModel::bias) bias.expect(2);  // up to a sixth too sure
}

INSTANTIATE_TEST_SUITE_P(,
                         NormalizedErrors,
                         testing::Values(RotationModel::known,
                                         RotationModel::bias,
                                         RotationModel::free),
                         [](const auto& each) { return std::string(to_string(each.param)); });

/// The walk is a worse enemy than the independent noise a frame that the solver takes it for.
TEST(Uncertainty, OfANoisyGyroscopeKnowsThatItsNoiseWalks) {
  const Method& method = find_method("gpo_joint");
  ChiSquare normal{2}, center{3}, middle{3};
  for (std::uint64_t seed = 1; seed <= 240; ++seed) {
    const Motion motion = std::array{Motion::orbit, Motion::wander, Motion::arc}[seed % 3];
    const Simulation truth = with_fitted_homographies(simulate({.motion = motion,
                                                                .noise_px = 0.2,
                                                                .gyro_bias_rad_s = 0.01,
                                                                .gyro_noise_rad_s = 0.01,
                                                                .seed = seed}));
    const Initialization result = assessed(
        method, truth.window, method.initialize(truth.window, {.shutter = Shutter::global}, {}));
    ASSERT_TRUE(result.ok) << result.reason;
    EXPECT_EQ(result.uncertainty->rotations, RotationModel::bias) << seed;
    add_errors(truth, result, normal, center);
    middle.add(normalized_square(result.cameras[15].p_wc - truth.cameras[15].p_wc,
                                 result.uncertainty->center_covariances[15]),
               kQuantile3);
  }
  normal.expect();
  center.expect();
  middle.expect();
}

TEST(Uncertainty, OfAHeldBiasIsWhatItsPriorCosts) {
  const Method& method = find_method("gpo");
  ChiSquare normal{2}, center{3};
  for (std::uint64_t seed = 1; seed <= 240; ++seed) {
    const Motion motion = std::array{Motion::orbit, Motion::wander, Motion::arc}[seed % 3];
    const Simulation truth = window_of(motion, RotationModel::bias, seed);
    const Initialization result =
        assessed(method, truth.window, method.initialize(truth.window, {}, {}));
    ASSERT_TRUE(result.ok) << result.reason;
    EXPECT_EQ(result.uncertainty->rotations, RotationModel::known);
    add_errors(truth, result, normal, center);
  }
  normal.expect();
  center.expect();
}

/// How a window's points move where the focal length is longer, and where the first radial
/// coefficient is larger: K is 500 px, the principal point in the middle of 640 x 480.
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

const MethodOptions kSquared = {.loss = Loss::squared};

// What a wrong lens does to the answer is what is said of it: the window's points are moved, and
// normal and centers go where the implicit function theorem sends them.
TEST(Uncertainty, CarriesTheLensThrough) {
  const Method& method = find_method("gpo_joint");
  for (const RotationModel model :
       {RotationModel::known, RotationModel::bias, RotationModel::free}) {
    const Simulation truth = window_of(Motion::wander, model, 5);
    const auto moves = lens_moves(truth.window, 1e-2, 1e-5);
    const std::size_t last = truth.cameras.size() - 1;
    for (int k = 0; k < 2; ++k) {
      const auto solved = [&](double sign) {
        Window window = truth.window;
        for (int i = 0; i < window.frame_count(); ++i) window.points_px[i] += sign * moves[k][i];
        return method.initialize(window, kSquared, {});
      };
      Window window = truth.window;
      const auto plain = assessed(method, window, method.initialize(window, kSquared, {}));
      window.lens_moves_px = {moves[k]};
      const auto with_lens = assessed(method, window, method.initialize(window, kSquared, {}));
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
      expect_outer((more.cameras[last].p_wc - less.cameras[last].p_wc) / 2,
                   with_lens.uncertainty->center_covariances[last] -
                       plain.uncertainty->center_covariances[last]);
    }
  }
}

// Lenses as uncertain as they are said to be. Taken as exact they would make the mean 78 and 46;
// much worse lenses are beyond the first order.
TEST(Uncertainty, OfALensFollowsTheChiSquareDistribution) {
  const Method& method = find_method("gpo_joint");
  ChiSquare normal{2}, center{3};
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    const Motion motion = std::array{Motion::orbit, Motion::wander, Motion::arc}[seed % 3];
    const Simulation truth = window_of(motion, RotationModel::known, seed);
    const auto moves = lens_moves(truth.window, 1.5, 0.0006);
    Window window = truth.window;
    std::mt19937_64 random(seed);
    for (const auto& of_parameter : moves) {
      const double error = std::normal_distribution<double>()(random);
      for (int i = 0; i < window.frame_count(); ++i) window.points_px[i] += error * of_parameter[i];
    }
    window.lens_moves_px = moves;
    const Initialization result = assessed(method, window, method.initialize(window, kSquared, {}));
    ASSERT_TRUE(result.ok) << result.reason;
    add_errors(truth, result, normal, center);
  }
  normal.expect();
  center.expect();
}

/// Moves what every frame sees by a smooth field over the picture, of up to about `most_px`, as a
/// lens does that is not quite its model; what the reference frame sees is moved too.
void bend_images(Window& window, double most_px, std::uint64_t seed) {
  std::mt19937_64 random(seed + 1234);
  std::normal_distribution<double> gauss;
  const Eigen::Matrix<double, 2, 6> field =
      Eigen::Matrix<double, 2, 6>::NullaryExpr([&] { return most_px / 4 * gauss(random); });
  for (Eigen::Matrix2Xd& points : window.points_px) {
    for (int j = 0; j < points.cols(); ++j) {
      const double x = (points(0, j) - 320) / 240;
      const double y = (points(1, j) - 240) / 240;
      Eigen::Matrix<double, 6, 1> terms;
      terms << x * x, x * y, y * y, x * x * x, y * y * y, x * y * y;
      points.col(j) += field * terms;
    }
  }
}

struct Honesty {
  int windows = 0;
  int told = 0;         ///< in which neighbors' part was the larger one
  int beyond_four = 0;  ///< errors above four standard deviations
  double squares = 0;
};

Honesty honesty_of_windows(double bent_by_px) {
  const Method& method = find_method("gpo_joint");
  Honesty all;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    const Motion motion = std::array{Motion::orbit, Motion::wander, Motion::arc}[seed % 3];
    Simulation truth = simulate({.motion = motion, .noise_px = 0.1, .seed = seed});
    bend_images(truth.window, bent_by_px, seed);
    truth = with_fitted_homographies(truth);
    truth.window.rotations = RotationModel::free;
    const Initialization result = method.initialize(truth.window, {}, {});
    if (!result.ok) continue;
    const Uncertainty& u = *result.uncertainty;
    const double sigmas = angle_deg(result.plane.normal, truth.plane.normal) / u.normal_sigma_deg;
    ++all.windows;
    const double half = u.normal_sigma_deg * std::sqrt(0.5);
    all.told += u.neighbors_sigma_deg.value_or(0) > half ? 1 : 0;
    all.beyond_four += sigmas > 4 ? 1 : 0;
    all.squares += sigmas * sigmas;
  }
  return all;
}

TEST(Uncertainty, KnowsWhatNeighborsHaveWrongTogether) {
  const Honesty bent = honesty_of_windows(1);
  ASSERT_GT(bent.windows, 100);
  EXPECT_GT(bent.told, bent.windows / 2);
  EXPECT_LT(bent.beyond_four, bent.windows / 10);
}

TEST(Uncertainty, SeldomFindsNeighborsAgreeingByChance) {
  const Honesty noise = honesty_of_windows(0);
  ASSERT_GT(noise.windows, 110);
  EXPECT_LT(noise.told, 0.12 * noise.windows);
  EXPECT_NEAR(noise.squares / noise.windows, 1, 0.3);
}

TEST(Uncertainty, OfKnownRotationsIsTheBound) {
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

TEST(Uncertainty, GrowsWithWhatIsUnknown) {
  const Simulation truth =
      simulate({.motion = Motion::wander, .gyro_bias_rad_s = 0.002, .seed = 3});
  const auto sigma = [&](RotationModel model) {
    return uncertainty_of(truth.window, truth.plane, truth.cameras, model)->normal_sigma_deg;
  };
  const auto u = uncertainty_of(truth.window, truth.plane, truth.cameras, RotationModel::bias);
  EXPECT_LT(*u->bound_known_rotations_deg, sigma(RotationModel::bias));
  EXPECT_LT(sigma(RotationModel::bias), sigma(RotationModel::known));  // held, and wrong
  EXPECT_LT(sigma(RotationModel::bias), sigma(RotationModel::free));
}

TEST(Uncertainty, OfAPlaneThatNothingTellsIsNone) {
  const Simulation truth = simulate({.motion = Motion::rotation_only});
  EXPECT_FALSE(uncertainty_of(truth.window, truth.plane, truth.cameras, RotationModel::known));
}

}  // namespace
}  // namespace gpo::test
