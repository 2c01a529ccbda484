// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause

#include "engine/methods/joint/joint_solution.h"

#include "engine/geometry/statistics.h"
#include "engine/methods/initializers.h"
#include "tests/engine/methods/method_cases.h"
#include "tests/engine/simulated_window.h"

#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <random>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using Eigen::Vector3d, Eigen::VectorXd;

const MethodOptions kLatent{.error = ErrorModel::latent};

/// Squared error of the normal, normalized by its covariance of rank 2.
double normalized(const Vector3d& error, const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  const VectorXd along = eigen.eigenvectors().transpose() * error;
  return along(1) * along(1) / eigen.eigenvalues()(1) +
         along(2) * along(2) / eigen.eigenvalues()(2);
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value / static_cast<double>(values.size());
  return sum;
}

constexpr Motion kJointMotions[] = {
    Motion::sideways, Motion::orbit, Motion::wander, Motion::up_down};

TEST(JointSolution, HalvesTheErrorUnderNoiseInTheReferenceFrame) {
  std::vector<double> latent_deg, transfer_deg, normalized_errors;
  for (int k = 0; k < 40; ++k) {
    const Simulation simulation = simulate_fitted(noisy(kJointMotions[k % 4], 100 + k));
    const Initialization latent = initialize_gpo_joint(simulation.window, kLatent, {});
    const Initialization transfer =
        initialize_gpo_joint(simulation.window, {.error = ErrorModel::transfer}, {});
    ASSERT_TRUE(latent.ok && transfer.ok) << k << latent.reason << transfer.reason;
    const Vector3d& n = simulation.plane.normal;
    latent_deg.push_back(angle_deg(latent.plane.normal, n));
    transfer_deg.push_back(angle_deg(transfer.plane.normal, n));
    normalized_errors.push_back(
        normalized(latent.plane.normal - n, latent.uncertainty->normal_covariance));
  }
  EXPECT_LT(median(latent_deg), 0.7 * median(transfer_deg));
  EXPECT_LT(median(latent_deg), 0.05);
  EXPECT_GT(mean_of(normalized_errors), 1);
  EXPECT_LT(mean_of(normalized_errors), 3);
}

/// Returns the Cramér-Rao bound of the normal [deg] with true rotations and 0.5 px of noise in all
/// frames.
double bound_deg(const Simulation& simulation, std::optional<RowDelayPrior> row_delay) {
  constexpr double noise_px = 0.5;
  const PlaneMotion motion = true_motion(simulation);
  const PlaneObservations observations = plane_observations(simulation.window);
  const joint::Model model(
      simulation.window,
      observations,
      motion,
      {.row_delay = row_delay, .huber = false, .lens_parameters = false, .lens_residual = false});
  const joint::State state = model.first(motion);
  const joint::Scales scales{.sigma_px = noise_px, .reference_px = noise_px};
  joint::Predictions predictions;
  model.predict(state, predictions);
  const Eigen::MatrixXd information =
      model.linearize(state, predictions, scales, joint::Curvature::of_weights).A +
      model.priors(state, scales).information;
  const Eigen::MatrixXd columns =
      information.llt().solve(Eigen::MatrixXd::Identity(information.rows(), 2));
  return degrees(noise_px * std::sqrt(columns.topRows<2>().trace()));
}

/// The default is nearly as accurate as any estimate can be.
TEST(JointSolution, ErrorIsCloseToTheCramerRaoBound) {
  constexpr Motion kObservable[] = {Motion::sideways,
                                    Motion::orbit,
                                    Motion::approach,
                                    Motion::up_down,
                                    Motion::wander,
                                    Motion::arc};
  std::vector<double> errors_deg, bounds_deg, squares, shown_deg, global_bounds_deg;
  for (int k = 0; k < 102; ++k) {
    const Simulation simulation = test::with_fitted_homographies(
        test::simulate(noisy(kObservable[k % std::size(kObservable)], 1000 + k)));
    const Initialization result = initialize_gpo_joint(simulation.window, {}, {});
    ASSERT_TRUE(result.ok) << k << result.reason;
    errors_deg.push_back(angle_deg(result.plane.normal, simulation.plane.normal));
    bounds_deg.push_back(bound_deg(simulation, RowDelayPrior{0, 0.02 / 480}));
    shown_deg.push_back(*result.uncertainty->bound_known_rotations_deg);
    global_bounds_deg.push_back(bound_deg(simulation, std::nullopt));
    squares.push_back(std::pow(errors_deg.back() / bounds_deg.back(), 2));
  }
  EXPECT_LT(median(errors_deg), 1.15 * median(bounds_deg));
  EXPECT_LT(std::sqrt(mean_of(squares)), 1.15);
  EXPECT_NEAR(median(shown_deg) / median(global_bounds_deg), 1, 0.05);
}

TEST(JointSolution, EstimatesTheRowDelayWithoutBias) {
  std::vector<double> errors_us, in_sigmas, normalized_errors;
  for (int k = 0; k < 40; ++k) {
    SimulationOptions options = noisy(kJointMotions[k % 4], 200 + k);
    options.row_delay_s = 4e-5;
    const Simulation simulation = simulate_fitted(options);
    const Initialization result = initialize_gpo_joint(simulation.window, kLatent, {});
    ASSERT_TRUE(result.ok && result.row_delay_s) << k << result.reason;
    errors_us.push_back(1e6 * (*result.row_delay_s - 4e-5));
    in_sigmas.push_back(std::abs(*result.row_delay_s - 4e-5) /
                        *result.uncertainty->row_delay_sigma_s);
    normalized_errors.push_back(normalized(result.plane.normal - simulation.plane.normal,
                                           result.uncertainty->normal_covariance));
  }
  EXPECT_NEAR(mean_of(errors_us), 0, 0.6);
  EXPECT_LT(median(in_sigmas), 1.2);
  EXPECT_LT(mean_of(normalized_errors), 3);
}

TEST(JointSolution, FindsNoRowDelayOfAGlobalShutter) {
  int found = 0;
  for (int k = 0; k < 40; ++k) {
    const Simulation simulation = simulate_fitted(noisy(kJointMotions[k % 4], 300 + k));
    const Initialization result = initialize_gpo_joint(simulation.window, kLatent, {});
    ASSERT_TRUE(result.ok) << result.reason;
    found += result.row_delay_s ? 1 : 0;
    EXPECT_GT(result.uncertainty->row_delay_sigma_s.value_or(0), 0);
  }
  EXPECT_LE(found, 1);
}

TEST(JointSolution, UsesAKnownRowDelay) {
  SimulationOptions options = noisy(Motion::sideways, 7);
  options.row_delay_s = 4e-5;
  Simulation simulation = simulate_fitted(options);
  const double estimated =
      initialize_gpo_joint(simulation.window, kLatent, {}).uncertainty->normal_sigma_deg;
  simulation.window.row_delay = RowDelayPrior{4e-5, 1e-7};
  const Initialization known = initialize_gpo_joint(simulation.window, kLatent, {});
  EXPECT_LE(known.uncertainty->normal_sigma_deg, 1.05 * estimated);
  EXPECT_NEAR(known.row_delay_s.value_or(0), 4e-5, 4e-7);
}

TEST(JointScales, FindTheNoiseOfTheReferenceFrame) {
  for (const double reference_px : {0.2, 0.5, 1.0}) {
    SimulationOptions options = noisy(Motion::orbit, 11);
    options.reference_noise_px = reference_px;
    const Simulation simulation = simulate(options);
    const auto solution = joint::solve(simulation.window, true_motion(simulation), {}, {});
    ASSERT_TRUE(solution);
    EXPECT_NEAR(solution->scales.sigma_px, 0.5, 0.05);
    EXPECT_NEAR(solution->scales.reference_px, reference_px, 0.2 * reference_px + 0.05);
  }
}

/// Tracks that have another place in the reference frame do not count.
TEST(JointScales, FindTheNoiseOfTheReferenceFrameDespiteSlips) {
  Simulation simulation = simulate(noisy(Motion::orbit, 12));
  for (int j = 0; j < 15; ++j) simulation.window.points_px[0](j % 2, 10 * j) += 4;
  const auto solution = joint::solve(simulation.window, true_motion(simulation), {}, {});
  ASSERT_TRUE(solution);
  EXPECT_NEAR(solution->scales.sigma_px, 0.5, 0.05);
  EXPECT_NEAR(solution->scales.reference_px, 0.5, 0.1);
}

/// Adds an error of 1 px at the corners that no parameter of the lens describes.
Simulation with_lens_residual(Simulation simulation) {
  for (Eigen::Matrix2Xd& points : simulation.window.points_px)
    for (Eigen::Index j = 0; j < points.cols(); ++j) {
      const Eigen::Vector2d p = (points.col(j) - Eigen::Vector2d(319.5, 239.5)) / 400;
      points.col(j) += p * p.squaredNorm();
    }
  return simulation;
}

TEST(JointScales, FindALensResidual) {
  Simulation simulation = simulate(noisy(Motion::orbit, 13));
  const auto without = joint::solve(simulation.window, true_motion(simulation), {}, {});
  simulation = with_lens_residual(std::move(simulation));
  const auto with = joint::solve(simulation.window, true_motion(simulation), {}, {});
  ASSERT_TRUE(with && without);
  EXPECT_LT(without->scales.lens_px, 0.2);
  EXPECT_GE(with->scales.lens_px, 0.2);
  EXPECT_GT(with->uncertainty.normal_sigma_deg, without->uncertainty.normal_sigma_deg);
  EXPECT_LT(angle_deg(with->motion.normal, simulation.plane.normal), 0.3);
}

TEST(JointSolution, TakesTheLensResidualOutOfThePoints) {
  for (int k = 0; k < 4; ++k) {
    const Simulation exact = simulate(noisy(kJointMotions[k], 13 + k));
    const Simulation bent = with_fitted_homographies(with_lens_residual(exact));
    const Initialization without = initialize_gpo_joint(exact.window, kLatent, {});
    const Initialization with = initialize_gpo_joint(bent.window, kLatent, {});
    ASSERT_TRUE(with.ok && with.lens_residual) << k << with.reason;
    EXPECT_LT(*with.transfer_rms_px, 1.02 * *without.transfer_rms_px) << k;
    EXPECT_LT(*with.reprojection_rms_px, 1.02 * *without.reprojection_rms_px) << k;
  }
}

/// Poses and points are those of one row delay also where it is too small to be reported.
TEST(JointSolution, MovesPointsByAnInsignificantRowDelay) {
  const MethodOptions global{.error = ErrorModel::latent, .shutter = Shutter::global};
  double with_px2 = 0, without_px2 = 0;
  for (int k = 0; k < 12; ++k) {
    SimulationOptions options = noisy(kJointMotions[k % 4], 300 + k);
    options.row_delay_s = 1e-6;
    const Simulation simulation = simulate_fitted(options);
    const Initialization unknown = initialize_gpo_joint(simulation.window, kLatent, {});
    const Initialization without = initialize_gpo_joint(simulation.window, global, {});
    ASSERT_TRUE(unknown.ok && without.ok) << unknown.reason << without.reason;
    if (unknown.row_delay_s) continue;
    with_px2 += std::pow(*unknown.reprojection_rms_px, 2);
    without_px2 += std::pow(*without.reprojection_rms_px, 2);
  }
  EXPECT_GT(with_px2, 0);
  EXPECT_LT(with_px2, without_px2);
}

TEST(JointSolution, TakesAnyNumberOfLensErrors) {
  Simulation simulation = simulate_fitted(noisy(Motion::orbit, 23));
  auto focal = typical_lens_moves_px(simulation.window).front();
  const auto sigma_deg = [&](std::size_t count) {
    simulation.window.lens_moves_px.assign(count, focal);
    const Initialization result = initialize_gpo_joint(simulation.window, kLatent, {});
    EXPECT_TRUE(result.ok) << result.reason;
    return result.uncertainty->normal_sigma_deg;
  };
  const double one = sigma_deg(1);
  for (Eigen::Matrix2Xd& moves : focal) moves /= 10;
  EXPECT_NEAR(sigma_deg(100), one, 1e-4 * one);
}

/// A focal length and a radial distortion that are wrong by their standard deviations.
TEST(JointSolution, CoversTheErrorsOfACalibratedLens) {
  std::vector<double> errors;
  for (int k = 0; k < 40; ++k) {
    Simulation simulation = simulate(noisy(kJointMotions[k % 4], 500 + k));
    Window& window = simulation.window;
    const auto typical = typical_lens_moves_px(window);
    window.lens_moves_px = {typical[0], typical[3]};
    std::mt19937_64 random(k);
    for (const auto& moves_px : window.lens_moves_px) {
      const double factor = std::normal_distribution<double>()(random);
      for (int i = 0; i < window.frame_count(); ++i) window.points_px[i] += factor * moves_px[i];
    }
    simulation = with_fitted_homographies(std::move(simulation));
    const Initialization result = initialize_gpo_joint(simulation.window, kLatent, {});
    ASSERT_TRUE(result.ok) << k << result.reason;
    ASSERT_TRUE(result.uncertainty->lens_sigma_deg);
    EXPECT_FALSE(result.uncertainty->typical_lens_sigma_deg);
    errors.push_back(normalized(result.plane.normal - simulation.plane.normal,
                                result.uncertainty->normal_covariance));
  }
  EXPECT_GT(mean_of(errors), 0.8);
  EXPECT_LT(mean_of(errors), 3);
}

TEST(JointSolution, StopsOnRequestWithoutAResult) {
  const Simulation simulation = simulate(noisy(Motion::orbit, 19));
  std::stop_source source;
  source.request_stop();
  EXPECT_FALSE(
      joint::solve(simulation.window, true_motion(simulation), {}, Watch(source.get_token())));
}

/// The normal varies over a surface that is not flat; the model has none of its heights.
TEST(JointSolution, IncludesTheBendOfASurface) {
  SimulationOptions options = noisy(Motion::orbit, 21, 0.1);
  Simulation simulation = simulate(options);
  const Eigen::Matrix3d K_inverse = simulation.window.K.inverse();
  const auto N = normal_tangents(simulation.plane.normal);
  for (int j = 0; j < options.points; ++j) {
    const Vector3d ray = K_inverse * simulation.window.points_px[0].col(j).homogeneous();
    const Vector3d on_plane = *intersect(simulation.plane, Pose{}, ray);
    const double along = N.col(0).dot(on_plane);
    const Vector3d point = on_plane * (1 + 0.05 * along * along);
    for (int i = 1; i < options.frames; ++i) {
      const auto pixel = [&](const Vector3d& p) -> Eigen::Vector2d {
        return (simulation.window.K * to_camera(simulation.cameras[i], p)).hnormalized();
      };
      simulation.window.points_px[i].col(j) += pixel(point) - pixel(on_plane);
    }
  }
  simulation = with_fitted_homographies(std::move(simulation));
  const Initialization result = resampled_by("gpo_joint", simulation.window, kLatent);
  ASSERT_TRUE(result.ok) << result.reason;
  ASSERT_TRUE(result.uncertainty->bend_sigma_deg);
  EXPECT_GT(result.uncertainty->normal_sigma_deg, *result.uncertainty->bend_sigma_deg);
  EXPECT_GE(*result.uncertainty->typical_lens_sigma_deg, result.uncertainty->normal_sigma_deg);
}

TEST(SmoothPath, IsExactForQuadraticMotion) {
  const VectorXd t = VectorXd::LinSpaced(12, 0, 0.4);
  Eigen::MatrixXd values(12, 1);
  for (int i = 0; i < 12; ++i) values(i) = 1 + 2 * t(i) - 3 * t(i) * t(i);
  for (const double noise : {0.0, 0.01}) {
    const Derivatives slopes =
        smooth_derivatives(path_times(t), values, VectorXd::Constant(1, noise));
    for (int i = 0; i < 12; ++i) {
      EXPECT_NEAR(slopes.first(i), 2 - 6 * t(i), 1e-6) << i;
      EXPECT_NEAR(slopes.second(i), -6, 1e-4) << i;
    }
  }
}

/// The velocity of a noisy path is several times more accurate than by neighboring values, and its
/// claimed standard deviation is right.
TEST(SmoothPath, ReducesTheNoiseOfVelocities) {
  constexpr double kNoise = 1e-3;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0, kNoise);
  double by_differences = 0, smooth = 0, claimed = 0;
  for (int path = 0; path < 50; ++path) {
    const VectorXd t = VectorXd::LinSpaced(30, 0, 29 / 30.0);
    Eigen::MatrixXd values(30, 1);
    for (int i = 0; i < 30; ++i) values(i) = 0.3 * std::sin(2 * t(i)) + normal(random);
    const Derivatives slopes =
        smooth_derivatives(path_times(t), values, VectorXd::Constant(1, kNoise));
    for (int i = 5; i < 25; ++i) {
      const double truth = 0.6 * std::cos(2 * t(i));
      by_differences += std::pow((values(i + 1) - values(i - 1)) * 15 - truth, 2);
      smooth += std::pow(slopes.first(i) - truth, 2);
      claimed += std::pow(slopes.sigma(i), 2);
    }
  }
  EXPECT_LT(smooth, by_differences / 20);
  EXPECT_NEAR(smooth / claimed, 1.2, 0.7);
}

/// Paths whose third derivative is white noise, between the times as well.
TEST(SmoothPath, ClaimsTheErrorsOfVelocitiesOfExactPoses) {
  constexpr int kFrames = 20, kSteps = 60;  // per frame
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  double interior = 0, ends = 0;
  for (int path = 0; path < 200; ++path) {
    const VectorXd t = VectorXd::LinSpaced(kFrames, 0, (kFrames - 1) / 30.0);
    const double step_s = 1.0 / (30 * kSteps);
    Eigen::MatrixXd values(kFrames, 1);
    VectorXd velocities(kFrames);
    double x = 0, v = 0, a = 0;
    for (int k = 0; k <= (kFrames - 1) * kSteps; ++k) {
      if (k % kSteps == 0) {
        values(k / kSteps) = x;
        velocities(k / kSteps) = v;
      }
      x += step_s * v + 0.5 * step_s * step_s * a;
      v += step_s * a;
      a += std::sqrt(step_s) * normal(random);
    }
    const Derivatives slopes = smooth_derivatives(path_times(t), values, VectorXd::Zero(1));
    for (const int i : {0, kFrames - 1})
      ends += std::pow((slopes.first(i) - velocities(i)) / slopes.sigma(i), 2) / 400;
    for (int i = 6; i < 14; ++i)
      interior += std::pow((slopes.first(i) - velocities(i)) / slopes.sigma(i), 2) / 1600;
  }
  EXPECT_NEAR(interior, 1.1, 0.3);
  EXPECT_NEAR(ends, 1.1, 0.3);
}

/// A roll by more than half a turn, about an axis that the camera also moves along.
TEST(SmoothPath, FollowsRotationsBeyondHalfATurn) {
  const VectorXd t = VectorXd::LinSpaced(40, 0, 39 / 30.0);
  const Eigen::Vector3d rate_rad_s(0.3, -0.2, 3.6);
  PlaneMotion motion;
  for (const double seconds : t) {
    motion.R_wc.push_back(so3_exp(seconds * rate_rad_s));
    motion.tau.emplace_back(0.1 * seconds * Eigen::Vector3d::UnitZ());
  }
  for (const double noise : {0.0, 1e-4})
    for (const Velocity& velocity : smooth_velocities(path_times(t), motion, {noise, noise})) {
      EXPECT_LT((velocity.rotation_rad_s - rate_rad_s).norm(), 1e-6);
      EXPECT_LT(velocity.rotation_rad_s2.norm(), 1e-4);
    }
}

/// Rates that change their axis and size: the error is of second order in the time between frames.
TEST(SmoothPath, FollowsRotationsAboutChangingAxes) {
  const VectorXd t = VectorXd::LinSpaced(40, 0, 39 / 30.0);
  const auto rotation = [](double seconds) {
    return Eigen::Matrix3d(so3_exp({0, std::sin(3 * seconds), 0}) * so3_exp({0, 0, 2 * seconds}));
  };
  PlaneMotion motion;
  for (const double seconds : t) motion.R_wc.push_back(rotation(seconds));
  motion.tau.resize(motion.R_wc.size(), Eigen::Vector3d::Zero());
  const auto velocities = smooth_velocities(path_times(t), motion, {});
  for (int i = 5; i < 35; ++i) {
    constexpr double kStep_s = 1e-5;
    const Eigen::Matrix3d step = rotation(t(i) - kStep_s).transpose() * rotation(t(i) + kStep_s);
    EXPECT_LT((velocities[i].rotation_rad_s - so3_log(step) / (2 * kStep_s)).norm(), 0.005) << i;
  }
}

/// A hand that trembles at 6 Hz, in images at 20 Hz: the parabola through five values is wrong by
/// 20 % of the velocity.
TEST(SmoothPath, FollowsTremor) {
  const VectorXd t = VectorXd::LinSpaced(30, 0, 29 / 20.0);
  const double omega = 2 * std::numbers::pi * 6;
  const Eigen::MatrixXd values = (omega * t).array().sin().matrix();
  const Derivatives slopes = smooth_derivatives(path_times(t), values, VectorXd::Zero(1));
  for (int i = 5; i < 25; ++i)
    EXPECT_NEAR(slopes.first(i), omega * std::cos(omega * t(i)), 0.05 * omega) << i;
}

}  // namespace
}  // namespace gpo::test
