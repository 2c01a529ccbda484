// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"
#include "engine/methods/initializers.h"
#include "engine/methods/joint/joint_scales.h"
#include "engine/methods/joint/joint_solution.h"
#include "engine/methods/plane/linear_solutions.h"
#include "tests/engine/simulated_room.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <ceres/ceres.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using test::Motion;
using test::Simulation;
using test::SimulationOptions;

const MethodOptions kLatent{.error = ErrorModel::latent};

/// Tracks with the same noise in all frames.
SimulationOptions noisy(Motion motion, std::uint64_t seed, double noise_px = 0.5) {
  SimulationOptions options;
  options.motion = motion;
  options.noise_px = options.reference_noise_px = noise_px;
  options.seed = seed;
  return options;
}

PlaneMotion true_motion(const Simulation& simulation) {
  return motion_of(simulation.plane, simulation.cameras);
}

/// Squared error of the normal, normalized by its covariance of rank 2.
double normalized(const Vector3d& error, const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  const VectorXd along = eigen.eigenvectors().transpose() * error;
  return along(1) * along(1) / eigen.eigenvalues()(1) +
         along(2) * along(2) / eigen.eigenvalues()(2);
}

struct JointUnknowns {
  const char* name;
  RotationModel rotations;
  bool gyro_noise;
  bool time_offset;
  double row_delay_s;
};

class JointGradient : public testing::TestWithParam<JointUnknowns> {};

/// The gradient with the latent positions eliminated is the derivative of the cost with the latent
/// positions at their optimum.
TEST_P(JointGradient, EqualsDerivativeOfCost) {
  const JointUnknowns& unknowns = GetParam();
  SimulationOptions simulated = noisy(Motion::orbit, 3);
  simulated.frames = 6;
  simulated.points = 20;
  if (unknowns.rotations == RotationModel::bias) {
    simulated.gyro_bias_rad_s = 0.01;
    simulated.gyro_noise_rad_s = 0.002;
  }
  Simulation simulation = test::simulate(simulated);
  if (unknowns.rotations != RotationModel::bias) simulation.window.rotations = unknowns.rotations;
  PlaneMotion motion = true_motion(simulation);
  if (simulation.window.gyro) motion.bias_rad_s = simulation.window.gyro->bias_rad_s;
  motion.R_wc = simulation.window.R_wc;
  const PlaneObservations observations = plane_observations(simulation.window);
  const joint::Options options{.rotations = unknowns.rotations,
                               .gyro_noise = unknowns.gyro_noise,
                               .time_offset = unknowns.time_offset,
                               .row_delay = RowDelayPrior{unknowns.row_delay_s, 4e-5},
                               .huber = false};
  const joint::Model model(simulation.window, observations, motion, options);
  const joint::Scales scales{.sigma_px = 0.5, .reference_px = 0.5, .lens_px = 0.3};
  const VectorXd none = VectorXd::Zero(model.layout().size());
  using joint::Curvature;
  const joint::State start = model.first(motion);
  const joint::Normals first = model.linearize(start, scales, Curvature::of_weights);
  // The second step settles the latent positions.
  joint::State state = model.moved(start, none, first, scales);
  joint::Normals at = model.linearize(state, scales, Curvature::of_weights);
  state = model.moved(state, none, at, scales);
  at = model.linearize(state, scales, Curvature::of_weights);
  const VectorXd gradient = at.by_track.rowwise().sum() + model.priors(state, scales).gradient;
  const auto cost = [&](VectorXd::Index k, double step) {
    joint::State there = model.moved(state, step * VectorXd::Unit(none.size(), k), at, scales);
    there.velocities = state.velocities;  // held within an iteration
    return model.linearize(there, scales, Curvature::of_weights).cost +
           model.priors(there, scales).cost;
  };
  const VectorXd::Index row_delay = model.layout().at_row_delay();
  const VectorXd::Index held = model.layout().at_parameters();
  for (VectorXd::Index k = 0; k < none.size(); ++k) {
    if (k >= held && k < model.layout().at_lens()) continue;  // `JointLens` tests them
    // With a row delay the derivatives by the poses leave out its small rotations.
    if (unknowns.row_delay_s > 0 && k != row_delay) continue;
    const double step = k == row_delay ? 1e-9 : 1e-5;
    // The row is that of the predicted pixel in the derivative and of the observed one in the
    // error.
    const double tolerance = k == row_delay ? 0.03 : 2e-4;
    const double numeric = (cost(k, step) - cost(k, -step)) / (2 * step);
    const double scale = 0.5 * std::sqrt(std::max(at.A(k, k), 1e-12));
    EXPECT_NEAR(gradient(k), numeric, tolerance * (std::abs(numeric) + scale)) << k;
  }
}

/// Cost of a window with the motion held and the latent positions at their optimum.
double settled_cost(const Window& window, const PlaneMotion& motion, VectorXd& gradient) {
  const PlaneObservations observations = plane_observations(window);
  const joint::Options options{.row_delay = std::nullopt, .huber = false};
  const joint::Model model(window, observations, motion, options);
  const joint::Scales scales;
  joint::State state = model.first(motion);
  joint::Normals at;
  for (int round = 0; round < 3; ++round) {
    at = model.linearize(state, scales, joint::Curvature::of_weights);
    state = model.moved(state, VectorXd::Zero(model.layout().size()), at, scales);
  }
  gradient = at.by_track.rowwise().sum().segment(model.layout().at_parameters(),
                                                 model.layout().lens_parameters);
  return at.cost;
}

/// A lens parameter has the effect that its moves of the points have.
TEST(JointLens, GradientEqualsDerivativeOfCost) {
  SimulationOptions options = noisy(Motion::orbit, 3);
  options.frames = 6;
  options.points = 20;
  const Simulation simulation = test::simulate(options);
  const PlaneMotion motion = true_motion(simulation);
  const auto moves_px = typical_lens_moves_px(simulation.window);
  VectorXd gradient, ignored;
  settled_cost(simulation.window, motion, gradient);
  ASSERT_EQ(gradient.size(), std::ssize(moves_px));
  for (std::size_t p = 0; p < moves_px.size(); ++p) {
    const auto cost = [&](double step) {
      Window moved = simulation.window;
      for (int i = 0; i < options.frames; ++i) moved.points_px[i] += step * moves_px[p][i];
      return settled_cost(moved, motion, ignored);
    };
    constexpr double kStep = 1e-4;
    const double numeric = (cost(kStep) - cost(-kStep)) / (2 * kStep);
    EXPECT_NEAR(gradient(static_cast<VectorXd::Index>(p)), numeric, 1e-3 * std::abs(numeric) + 1e-3)
        << p;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Unknowns,
    JointGradient,
    testing::Values(JointUnknowns{"known", RotationModel::known, false, false, 0},
                    JointUnknowns{"free", RotationModel::free, false, false, 0},
                    JointUnknowns{"bias", RotationModel::bias, false, true, 0},
                    JointUnknowns{"noise", RotationModel::bias, true, true, 0},
                    JointUnknowns{"rolling", RotationModel::free, false, false, 4e-5}),
    [](const auto& tested) { return std::string(tested.param.name); });

/// Transfer error of a latent position; the reference camera is the world.
struct LatentError {
  const Simulation& simulation;
  int frame, track;

  template <class T>
  bool operator()(const T* normal, const T* tau, const T* latent, T* residual) const {
    const Eigen::Matrix3d& K = simulation.window.K;
    const Eigen::Matrix<T, 3, 1> x(
        (latent[0] - K(0, 2)) / K(0, 0), (latent[1] - K(1, 2)) / K(1, 1), T(1));
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> n(normal), t(tau);
    const Eigen::Matrix<T, 3, 1> y =
        simulation.window.R_wc[frame].transpose().cast<T>() * (x - t * n.dot(x));
    const Eigen::Vector2d p = simulation.window.points_px[frame].col(track);
    residual[0] = K(0, 0) * y(0) / y(2) + K(0, 2) - p(0);
    residual[1] = K(1, 1) * y(1) / y(2) + K(1, 2) - p(1);
    return true;
  }
};

struct ReferenceError {
  Eigen::Vector2d observed_px;
  double weight;

  template <class T>
  bool operator()(const T* latent, T* residual) const {
    for (int k = 0; k < 2; ++k) residual[k] = weight * (latent[k] - observed_px(k));
    return true;
  }
};

/// Returns a window and its solution without a lens residual, which Ceres' problem does not have.
std::pair<Simulation, joint::Solution> solved_without_lens(SimulationOptions options) {
  for (;; ++options.seed) {
    Simulation simulation = test::simulate(options);
    auto found = joint::solve(
        simulation.window, true_motion(simulation), {.row_delay = {}, .huber = false}, {});
    if (found && found->scales.lens_px == 0) return {std::move(simulation), std::move(*found)};
  }
}

TEST(JointSolution, IsTheMinimumThatCeresFinds) {
  SimulationOptions simulated = noisy(Motion::orbit, 5);
  simulated.frames = 8;
  simulated.points = 40;
  const auto [simulation, ours] = solved_without_lens(simulated);
  Vector3d normal = simulation.plane.normal;
  std::vector<Vector3d> tau = true_motion(simulation).tau;
  Eigen::Matrix2Xd latent = simulation.window.points_px[0];
  ceres::Problem problem;
  const double weight = ours.scales.sigma_px / ours.scales.reference_px;
  for (int j = 0; j < simulated.points; ++j) {
    const Eigen::Vector2d seen = simulation.window.points_px[0].col(j);
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<ReferenceError, 2, 2>(new ReferenceError{seen, weight}),
        nullptr,
        latent.col(j).data());
    for (int i = 1; i < simulated.frames; ++i)
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<LatentError, 2, 3, 3, 2>(
                                   new LatentError{simulation, i, j}),
                               nullptr,
                               normal.data(),
                               tau[i].data(),
                               latent.col(j).data());
  }
  problem.SetManifold(normal.data(), new ceres::SphereManifold<3>());
  ceres::Solver::Options solver;
  solver.function_tolerance = 1e-14;
  solver.max_num_iterations = 100;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  EXPECT_LT(angle_deg(ours.motion.normal, normal), 1e-3);
  for (int i = 1; i < simulated.frames; ++i)
    EXPECT_LT((ours.motion.tau[i] - tau[i]).norm(), 2e-5) << i;
}

/// Errors of the default and of the transfer error, and normalized squared errors of the default.
struct JointErrors {
  std::vector<double> latent_deg, transfer_deg, normalized;
};

JointErrors errors_of(const std::function<SimulationOptions(int)>& options, int windows) {
  JointErrors errors;
  for (int number = 0; number < windows; ++number) {
    const Simulation simulation = test::with_fitted_homographies(test::simulate(options(number)));
    const Initialization latent = initialize_gpo_joint(simulation.window, kLatent, {});
    const Initialization transfer = initialize_gpo_joint(simulation.window, {}, {});
    if (!latent.ok || !transfer.ok) {
      ADD_FAILURE() << number << latent.reason << transfer.reason;
      continue;
    }
    const Vector3d& n = simulation.plane.normal;
    errors.latent_deg.push_back(angle_deg(latent.plane.normal, n));
    errors.transfer_deg.push_back(angle_deg(transfer.plane.normal, n));
    errors.normalized.push_back(
        normalized(latent.plane.normal - n, latent.uncertainty->normal_covariance));
  }
  return errors;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value / static_cast<double>(values.size());
  return sum;
}

constexpr Motion kJointMotions[] = {
    Motion::sideways, Motion::orbit, Motion::wander, Motion::up_down};

TEST(JointSolution, HalvesTheErrorUnderNoiseInTheReferenceFrame) {
  const JointErrors errors =
      errors_of([](int k) { return noisy(kJointMotions[k % 4], 100 + k); }, 40);
  EXPECT_LT(median(errors.latent_deg), 0.7 * median(errors.transfer_deg));
  EXPECT_LT(median(errors.latent_deg), 0.05);
  EXPECT_GT(mean_of(errors.normalized), 1);
  EXPECT_LT(mean_of(errors.normalized), 3);
}

TEST(JointSolution, EstimatesTheRowDelayWithoutBias) {
  std::vector<double> errors_us, in_sigmas;
  const auto rolling = [&](int k) {
    SimulationOptions options = noisy(kJointMotions[k % 4], 200 + k);
    options.row_delay_s = 4e-5;
    return options;
  };
  std::vector<double> normalized_errors;
  for (int k = 0; k < 40; ++k) {
    const Simulation simulation = test::with_fitted_homographies(test::simulate(rolling(k)));
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
    const Simulation simulation =
        test::with_fitted_homographies(test::simulate(noisy(kJointMotions[k % 4], 300 + k)));
    const Initialization result = initialize_gpo_joint(simulation.window, kLatent, {});
    ASSERT_TRUE(result.ok) << result.reason;
    found += result.row_delay_s ? 1 : 0;
    EXPECT_GT(result.uncertainty->row_delay_sigma_s.value_or(0), 0);
  }
  EXPECT_LE(found, 1);
}

/// A known row delay determines the normal at least as well as an estimated one.
TEST(JointSolution, UsesAKnownRowDelay) {
  SimulationOptions options = noisy(Motion::sideways, 7);
  options.row_delay_s = 4e-5;
  Simulation simulation = test::with_fitted_homographies(test::simulate(options));
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
    const Simulation simulation = test::simulate(options);
    const auto solution = joint::solve(simulation.window, true_motion(simulation), {}, {});
    ASSERT_TRUE(solution);
    EXPECT_NEAR(solution->scales.sigma_px, 0.5, 0.05);
    EXPECT_NEAR(solution->scales.reference_px, reference_px, 0.2 * reference_px + 0.05);
  }
}

/// A lens residual of one pixel at the corners is found and widens the uncertainty.
TEST(JointScales, FindALensResidual) {
  Simulation simulation = test::simulate(noisy(Motion::orbit, 13));
  const auto without = joint::solve(simulation.window, true_motion(simulation), {}, {});
  for (Eigen::Matrix2Xd& points : simulation.window.points_px) {
    for (Eigen::Index j = 0; j < points.cols(); ++j) {
      const Eigen::Vector2d p = (points.col(j) - Eigen::Vector2d(319.5, 239.5)) / 400;
      points.col(j) += p * p.squaredNorm();
    }
  }
  const auto with = joint::solve(simulation.window, true_motion(simulation), {}, {});
  ASSERT_TRUE(with && without);
  EXPECT_LT(without->scales.lens_px, 0.2);
  EXPECT_GE(with->scales.lens_px, 0.2);
  EXPECT_GT(with->uncertainty.normal_sigma_deg, without->uncertainty.normal_sigma_deg);
  EXPECT_LT(angle_deg(with->motion.normal, simulation.plane.normal), 0.3);
}

/// A focal length and a radial distortion that are wrong by their standard deviations.
TEST(JointSolution, CoversTheErrorsOfACalibratedLens) {
  std::vector<double> errors;
  for (int k = 0; k < 40; ++k) {
    Simulation simulation = test::simulate(noisy(kJointMotions[k % 4], 500 + k));
    Window& window = simulation.window;
    const auto typical = typical_lens_moves_px(window);
    window.lens_moves_px = {typical[0], typical[3]};
    std::mt19937_64 random(k);
    for (const auto& moves_px : window.lens_moves_px) {
      const double factor = std::normal_distribution<double>()(random);
      for (int i = 0; i < window.frame_count(); ++i) window.points_px[i] += factor * moves_px[i];
    }
    simulation = test::with_fitted_homographies(std::move(simulation));
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
  const Simulation simulation = test::simulate(noisy(Motion::orbit, 19));
  std::stop_source source;
  source.request_stop();
  EXPECT_FALSE(
      joint::solve(simulation.window, true_motion(simulation), {}, Watch(source.get_token())));
}

/// The normal varies over a surface that is not flat; the model has none of its heights.
TEST(JointSolution, IncludesTheBendOfASurface) {
  SimulationOptions options = noisy(Motion::orbit, 21, 0.1);
  Simulation simulation = test::simulate(options);
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
  simulation = test::with_fitted_homographies(std::move(simulation));
  const Initialization result = initialize_gpo_joint(simulation.window, kLatent, {});
  ASSERT_TRUE(result.ok) << result.reason;
  ASSERT_TRUE(result.uncertainty->bend_sigma_deg);
  EXPECT_GT(result.uncertainty->normal_sigma_deg, *result.uncertainty->bend_sigma_deg);
  EXPECT_GE(*result.uncertainty->typical_lens_sigma_deg, result.uncertainty->normal_sigma_deg);
}

TEST(JointSolution, TypicalCalibrationWidensTheNormal) {
  const Simulation simulation = test::simulate(noisy(Motion::orbit, 17));
  const auto solution = joint::solve(simulation.window, true_motion(simulation), {}, {});
  ASSERT_TRUE(solution && solution->uncertainty.typical_lens_sigma_deg);
  EXPECT_GT(*solution->uncertainty.typical_lens_sigma_deg, solution->uncertainty.normal_sigma_deg);
}

TEST(SmoothPath, IsExactForQuadraticMotion) {
  const VectorXd t = VectorXd::LinSpaced(12, 0, 0.4);
  Eigen::MatrixXd values(12, 1);
  for (int i = 0; i < 12; ++i) values(i) = 1 + 2 * t(i) - 3 * t(i) * t(i);
  for (const double noise : {0.0, 0.01}) {
    const Derivatives slopes = smooth_derivatives(t, values, VectorXd::Constant(1, noise));
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
    const Derivatives slopes = smooth_derivatives(t, values, VectorXd::Constant(1, kNoise));
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

}  // namespace
}  // namespace gpo
