// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/joint/joint_solution.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <ceres/ceres.h>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

using Eigen::Vector3d, Eigen::VectorXd;

struct JointUnknowns {
  const char* name;
  RotationModel rotations;
  bool gyro_noise, time_offset;
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
  Simulation simulation = simulate(simulated);
  if (unknowns.rotations != RotationModel::bias) simulation.window.rotations = unknowns.rotations;
  if (simulation.window.gyro && !unknowns.time_offset)
    simulation.window.gyro->time_offset_sigma_s = 0;
  PlaneMotion motion = true_motion(simulation);
  if (simulation.window.gyro) motion.bias_rad_s = simulation.window.gyro->bias_rad_s;
  motion.R_wc = simulation.window.R_wc;
  const PlaneObservations observations = plane_observations(simulation.window);
  const joint::Options options{.rotations = unknowns.rotations,
                               .gyro_noise = unknowns.gyro_noise,
                               .row_delay = RowDelayPrior{unknowns.row_delay_s, 4e-5},
                               .huber = false};
  const joint::Model model(simulation.window, observations, motion, options);
  const joint::Scales scales{.sigma_px = 0.5, .reference_px = 0.5, .lens_px = 0.3};
  const VectorXd none = VectorXd::Zero(model.layout().size());
  const auto linearized = [&](const joint::State& state) {
    joint::Predictions predictions;
    model.predict(state, predictions);
    return model.linearize(state, predictions, scales, joint::Curvature::of_weights);
  };
  const joint::State start = model.first(motion);
  const joint::Normals first = linearized(start);
  // The second step settles the latent positions.
  joint::State state = model.moved(start, none, first);
  joint::Normals at = linearized(state);
  state = model.moved(state, none, at);
  at = linearized(state);
  const VectorXd gradient = at.gradient + model.priors(state, scales).gradient;
  const auto cost = [&](VectorXd::Index k, double step) {
    const joint::State there = model.moved(state, step * VectorXd::Unit(none.size(), k), at);
    return linearized(there).cost + model.priors(there, scales).cost;
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
  joint::Predictions predictions;
  for (int round = 0; round < 3; ++round) {
    model.predict(state, predictions);
    at = model.linearize(state, predictions, scales, joint::Curvature::of_weights);
    state = model.moved(state, VectorXd::Zero(model.layout().size()), at);
  }
  gradient = at.gradient.segment(model.layout().at_parameters(), model.layout().lens_parameters);
  return at.cost;
}

/// A lens parameter has the effect that its moves of the points have.
TEST(JointLens, GradientEqualsDerivativeOfCost) {
  SimulationOptions options = noisy(Motion::orbit, 3);
  options.frames = 6;
  options.points = 20;
  const Simulation simulation = simulate(options);
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
    Simulation simulation = simulate(options);
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

}  // namespace
}  // namespace gpo::test
