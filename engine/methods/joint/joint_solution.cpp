// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/joint/joint_solution.h"

#include "engine/methods/joint/joint_scales.h"
#include "engine/methods/joint/joint_uncertainty.h"
#include "engine/methods/plane/linear_solutions.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

namespace gpo::joint {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kMostIterations = 12;
/// Then the velocities stay, because two smoothings may take turns.
constexpr int kVelocityIterations = 5;
constexpr double kSettled_rad = 2e-6;  // step of the normal
/// Last step of a solution relative to its standard deviation: the noise and the weights that are
/// estimated along with it never quite settle.
constexpr double kSettledSigmas = 0.1;
constexpr double kFitsAsWell = 9;  // chi-square
constexpr double kCloseTwins_deg = 20;

/// All observations of the planes' tracks count as inliers: the gate around the homographies would
/// cut off what a rolling shutter or strong noise adds, and bias the estimates.
Window with_all_observations(Window window) {
  const auto admit = [&](std::vector<std::vector<bool>>& inlier, const std::vector<int>& tracks) {
    for (int i = 0; i < window.frame_count(); ++i)
      for (const int j : tracks) inlier[i][j] = window.points_px[i].col(j).allFinite();
  };
  admit(window.inlier, window.inlier_tracks(0));
  for (WindowPlane& plane : window.planes) admit(plane.inlier, plane.tracks);
  return window;
}

struct Iteration {
  const Model& model;
  const Watch& watch;
  State state;
  Scales scales;
  SolverReport solver = {};
  double last_step = 0;      ///< length over all unknowns
  double last_step_rad = 0;  ///< change of the normal
};

void add_to_trace(const Normals& normals, const Priors& priors, Iteration& at) {
  const VectorXd gradient = normals.by_track.rowwise().sum() + priors.gradient;
  at.solver.trace.push_back({normals.cost + priors.cost,
                             gradient.cwiseAbs().maxCoeff(),
                             at.last_step,
                             at.state.motion.normal});
}

/// Iterates Gauss-Newton steps and estimates of the noise; false if a step is not determined or the
/// watch stops it.
bool converge(Iteration& at) {
  for (int k = 0; k < kMostIterations && !at.watch.stop_requested(); ++k) {
    const Normals normals = at.model.linearize(at.state, at.scales, Curvature::of_weights);
    const Priors priors = at.model.priors(at.state, at.scales);
    const Eigen::LLT<Eigen::MatrixXd> factor(normals.A + priors.information);
    if (!normals.in_front || factor.info() != Eigen::Success) return false;
    const VectorXd gradient = normals.by_track.rowwise().sum() + priors.gradient;
    const VectorXd x = -factor.solve(gradient);
    if (!x.allFinite()) return false;
    add_to_trace(normals, priors, at);
    const std::vector<Velocity> before = at.state.velocities;
    at.state = at.model.moved(at.state, x, normals, at.scales);
    if (k >= kVelocityIterations) at.state.velocities = before;
    at.scales.sigma_px = noise_px(at.model, at.state);
    at.scales.reference_px = reference_noise_px(at.model, at.state, normals, at.scales);
    at.watch.report(++at.solver.iterations, normals.cost + priors.cost);
    at.last_step = x.norm();
    at.last_step_rad = x.head<2>().norm();
    if (at.last_step_rad < kSettled_rad) break;
  }
  return !at.watch.stop_requested();
}

}  // namespace

std::optional<Solution> solve(const Window& window,
                              const PlaneMotion& start,
                              const Options& options,
                              const Watch& watch) {
  const auto begin = std::chrono::steady_clock::now();
  const Window all = with_all_observations(window);
  const PlaneObservations observations = plane_observations(all, numbers_of(start.others));
  const Model model(all, observations, start, options);
  Iteration at{model, watch, model.first(start), {}};
  at.scales.sigma_px = noise_px(model, at.state);
  at.scales.reference_px = at.scales.sigma_px;
  if (!converge(at)) return std::nullopt;
  find_lens_residual(
      model, at.state, model.linearize(at.state, at.scales, Curvature::of_weights), at.scales);
  if (at.scales.lens_px > 0 && !converge(at)) return std::nullopt;
  Options last = options;
  last.free_velocities = options.row_delay.has_value();
  const Model whole(all, observations, at.state.motion, last);
  const Normals normals = whole.linearize(
      at.state, at.scales, options.huber ? Curvature::of_loss : Curvature::of_weights);
  if (!normals.in_front) return std::nullopt;
  const int tracks = static_cast<int>(model.tracks().size());
  SolverReport& solver = at.solver;
  add_to_trace(normals, whole.priors(at.state, at.scales), at);
  solver.initial_cost = solver.trace.front().cost;
  solver.final_cost = solver.trace.back().cost;
  solver.unknowns = model.layout().size() - model.layout().lens_parameters + 2 * tracks;
  solver.residuals = 2 * (model.observation_count() + tracks);
  solver.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  Solution solution{.motion = at.state.motion,
                    .solver = std::move(solver),
                    .scales = at.scales,
                    .row_delay_s = at.state.row_delay_s,
                    .uncertainty = uncertainty_of(whole, at.state, normals, at.scales)};
  if (!solution.uncertainty.joint_covariance.allFinite()) return std::nullopt;
  const double settled_rad =
      kSettledSigmas * std::sqrt(solution.uncertainty.normal_covariance.trace());
  solution.solver.termination = at.last_step_rad < std::max(kSettled_rad, settled_rad)
                                    ? Termination::convergence
                                    : Termination::no_convergence;
  return solution;
}

Solution better_of_twins(Solution one, Solution other) {
  if (other.solver.final_cost < one.solver.final_cost) std::swap(one, other);
  const PlaneMotion& motion = one.motion;
  PlaneMotion twin = other.motion;
  if (twin.normal.dot(motion.normal) < 0) {
    twin.normal = -twin.normal;
    for (Eigen::Vector3d& tau : twin.tau) tau = -tau;
  }
  const double angle_deg =
      degrees(std::acos(std::clamp(twin.normal.dot(motion.normal), -1.0, 1.0)));
  const double chi_square =
      2 * (other.solver.final_cost - one.solver.final_cost) / std::pow(one.scales.sigma_px, 2);
  if (chi_square > kFitsAsWell || angle_deg > kCloseTwins_deg) return one;
  Uncertainty& u = one.uncertainty;
  const auto N = normal_tangents(motion.normal);
  const Index frames = std::ssize(motion.tau);
  VectorXd half = VectorXd::Zero(u.joint_covariance.rows());
  VectorXd half_of_poses(6 * (frames - 1));
  for (Index i = 1; i < frames; ++i) {
    auto center = half.segment<3>(3 * (i - 1));
    center = -0.5 * (twin.tau[i] - motion.tau[i]);
    half_of_poses.segment<6>(6 * (i - 1))
        << 0.5 * so3_log(motion.R_wc[i].transpose() * twin.R_wc[i]),
        center;
    u.center_covariances[i] += center * center.transpose();
    const double ratio = 0.5 * (motion.normal.dot(motion.tau[i]) - twin.normal.dot(twin.tau[i]));
    u.distance_ratio_sigmas[i] = std::hypot(u.distance_ratio_sigmas[i], ratio);
  }
  const Eigen::Vector2d tangent = 0.5 * (N.transpose() * (twin.normal - motion.normal));
  half.segment<2>(3 * (frames - 1) + u.joint_bias_rows) = tangent;
  u.joint_covariance += half * half.transpose();
  u.pose_covariance += half_of_poses * half_of_poses.transpose();
  set_normal_covariance(u.normal_covariance + N * tangent * tangent.transpose() * N.transpose(), u);
  return one;
}

}  // namespace gpo::joint
