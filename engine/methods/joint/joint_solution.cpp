// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/joint/joint_solution.h"

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

constexpr int kMostIterations = 20;
/// Without a part of the tracks, from the solution of all: the variance of the normal by regions is
/// within 5 % of that of converged runs.
constexpr int kRestartIterations = 3;
/// Then the velocities stay, because two smoothings may take turns.
constexpr int kVelocityIterations = 5;
/// Root mean square of the last step over all unknowns, in their standard deviations.
constexpr double kSettledSigmas = 0.003;
/// The same of a solution: the noise and the weights that are estimated along with it never quite
/// settle.
constexpr double kNearlySettledSigmas = 0.1;
/// A Newton step on the loss diverges if it multiplies the cost by more.
constexpr double kMostRise = 1.5;
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
  const Watch& watch;
  State state;
  Predictions predictions;  ///< at the state
  Scales scales;
  double most_cost = 0;
  Normals normals = {};  ///< last linearization
  SolverReport solver = {};
  double last_step = 0;         ///< length over all unknowns, each in its unit
  double last_step_sigmas = 0;  ///< its root mean square in standard deviations of the unknowns
};

void add_to_trace(const Priors& priors, Iteration& at) {
  const VectorXd gradient = at.normals.gradient + priors.gradient;
  at.solver.trace.push_back({at.normals.cost + priors.cost,
                             gradient.cwiseAbs().maxCoeff(),
                             at.last_step,
                             at.state.motion.normal});
}

void linearize(const Model& model, Curvature curvature, Iteration& at) {
  at.normals =
      model.linearize(at.state, at.predictions, at.scales, curvature, std::move(at.normals));
}

/// The estimates before a step.
struct Checkpoint {
  State state;
  Predictions predictions;
  Scales scales;
  double cost = 0;
};

void restore(Checkpoint before, Iteration& at) {
  at.state = std::move(before.state);
  at.predictions = std::move(before.predictions);
  at.scales = before.scales;
}

/// Relaxation by the ratio of consecutive steps (Aitken): reweighted steps may overshoot again and
/// again, or be too short, along a direction that the window hardly determines. The ratio is that
/// of the inner product by the information H, in which all unknowns have the unit of their standard
/// deviations.
struct Relaxation {
  static constexpr double kLeast = 0.3, kMost = 3;
  double factor = 1;
  VectorXd last = {};  ///< previous step, not relaxed; empty after a step of another kind

  /// `step` is -H^-1 gradient.
  double next(const VectorXd& step, const VectorXd& gradient, const Eigen::MatrixXd& H) {
    if (last.size() != step.size()) {
      factor = 1;
    } else {
      const double left = 1 + last.dot(gradient) / last.dot(H * last);
      factor = left > 0 ? std::clamp(factor / left, kLeast, kMost) : kMost;
    }
    last = step;
    return factor;
  }
};

/// Iterates Newton steps and estimates of the noise; false if a step is not determined or the watch
/// stops it.
bool converge(const Model& model, Iteration& at) {
  // Reweighting is safe far from the minimum, the curvature of the loss is fast near it. It may
  // cycle where many errors are near the knee, and diverge where it hardly determines an unknown.
  Curvature curvature = Curvature::of_weights;
  bool newton = model.options().huber;
  std::optional<Checkpoint> before;  // the last step, if it was one on the loss
  PathNoise noise;
  const Normals& normals = at.normals;
  Priors priors;
  Eigen::MatrixXd H;
  Eigen::LLT<Eigen::MatrixXd> factor;
  Relaxation relaxation;
  const int most = model.options().uncertainty ? kMostIterations : kRestartIterations;
  for (int k = 0; k < most && !at.watch.stop_requested(); ++k) {
    linearize(model, curvature, at);
    priors = model.priors(at.state, at.scales, std::move(priors));
    const double cost = normals.cost + priors.cost;
    if (before && !(normals.in_front && cost <= kMostRise * before->cost)) {
      restore(std::move(*before), at);
      before.reset();
      curvature = Curvature::of_weights;
      newton = false;
      continue;
    }
    H = normals.A + priors.information;
    factor.compute(H);
    if (!normals.in_front || factor.info() != Eigen::Success) return false;
    const VectorXd gradient = normals.gradient + priors.gradient;
    const VectorXd x = -factor.solve(gradient);
    if (!x.allFinite()) return false;
    add_to_trace(priors, at);
    constexpr double kMargin = 20;  // times the expected decrease
    const double decrease = std::max(0.0, -0.5 * gradient.dot(x));
    if (k > 1 && cost - kMargin * decrease > at.most_cost) return false;
    before.reset();
    double relaxed = 1;
    if (curvature == Curvature::of_loss) {
      before = {at.state, at.predictions, at.scales, cost};
      relaxation = {};
    } else {
      noise = model.path_noise(normals, at.scales);
      relaxed = relaxation.next(x, gradient, H);
    }
    const double step_sigmas =
        std::sqrt(2 * decrease / static_cast<double>(x.size())) / at.scales.sigma_px;
    at.state = model.moved(at.state, relaxed * x, normals);
    if (k < kVelocityIterations) model.update_velocities(at.state, noise);
    model.predict(at.state, at.predictions);
    at.scales.sigma_px = noise_px(model, at.predictions);
    at.scales.reference_px = reference_noise_px(model, at.predictions, normals, at.scales);
    at.watch.report(++at.solver.iterations, cost);
    const bool shrinks = k > 0 && step_sigmas < 0.5 * at.last_step_sigmas;
    if (curvature == Curvature::of_loss && !shrinks) newton = false;
    curvature = newton && shrinks ? Curvature::of_loss : Curvature::of_weights;
    at.last_step = x.norm();
    at.last_step_sigmas = step_sigmas;
    if (step_sigmas < kSettledSigmas) break;
  }
  return !at.watch.stop_requested();
}

/// Returns the components of the frames' velocities that affect the uncertainty: those that the
/// path leaves uncertain, unless they move no row by a relevant share of the noise.
int unknown_velocity(const Iteration& at, Index tracks, const Window& window) {
  constexpr double kLeastInformation = 1e-5;
  double tau_s = 0, rotation_rad_s = 0;
  for (const Velocity& velocity : at.state.velocities) {
    tau_s = std::max(tau_s, velocity.tau_sigma_s);
    rotation_rad_s = std::max(rotation_rad_s, velocity.rotation_sigma_rad_s);
  }
  const double seconds = 0.5 * window.row_count() * at.state.row_delay_s;
  const double moved_px = seconds * window.K(0, 0) * std::max(tau_s, rotation_rad_s);
  const double information =
      static_cast<double>(tracks) * std::pow(moved_px / at.scales.sigma_px, 2);
  if (!(information > kLeastInformation)) return 0;
  return rotation_rad_s > 0 ? 6 : 3;
}

}  // namespace

std::optional<Solution> solve(const Window& window,
                              const PlaneMotion& start,
                              const Options& options,
                              const Watch& watch,
                              const Rival& rival) {
  const auto begin = std::chrono::steady_clock::now();
  const Window all = with_all_observations(window);
  const PlaneObservations observations = plane_observations(all, numbers_of(start.others));
  Options unknown = options;
  unknown.lens_parameters = unknown.lens_residual = false;
  const Model model(all, observations, start, unknown);
  Iteration at{.watch = watch,
               .state = model.first(start),
               .predictions = {},
               .scales = {},
               .most_cost = rival.cost * rival.most_ratio};
  model.predict(at.state, at.predictions);
  at.scales.sigma_px = noise_px(model, at.predictions);
  at.scales.reference_px = at.scales.sigma_px;
  if (!converge(model, at)) return std::nullopt;
  unknown.lens_residual = true;
  const Model with_lens = model.with(unknown);
  linearize(with_lens, Curvature::of_weights, at);
  find_lens_residual(with_lens, at.state, at.normals, at.scales);
  if (at.scales.lens_px > 0 && !converge(with_lens, at)) return std::nullopt;
  if (!options.uncertainty)
    return Solution{
        .motion = at.state.motion, .solver = at.solver, .scales = at.scales, .uncertainty = {}};
  unknown.lens_parameters = true;
  unknown.velocity = unknown_velocity(at, std::ssize(model.tracks()), all);
  const Model whole = model.with(unknown);
  linearize(whole, options.huber ? Curvature::of_loss : Curvature::of_weights, at);
  if (!at.normals.in_front) return std::nullopt;
  const int tracks = static_cast<int>(model.tracks().size());
  SolverReport& solver = at.solver;
  add_to_trace(whole.priors(at.state, at.scales), at);
  solver.initial_cost = solver.trace.front().cost;
  solver.final_cost = solver.trace.back().cost;
  solver.unknowns = with_lens.layout().size() + 2 * tracks;
  solver.residuals = 2 * (model.observation_count() + tracks);
  solver.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  Solution solution{.motion = at.state.motion,
                    .solver = std::move(solver),
                    .scales = at.scales,
                    .row_delay_s = at.state.row_delay_s,
                    .uncertainty = {}};
  if (at.scales.lens_px > 0) solution.lens_residual = whole.lens_residual(at.state);
  solution.solver.termination = at.last_step_sigmas < kNearlySettledSigmas
                                    ? Termination::convergence
                                    : Termination::no_convergence;
  if (solution.solver.final_cost > rival.cost) return solution;
  solution.uncertainty = uncertainty_of(whole, at.state, at.normals, at.scales);
  if (!solution.uncertainty.joint_covariance.allFinite()) return std::nullopt;
  return solution;
}

Solution better_of_twins(Solution one, Solution other) {
  if (other.solver.final_cost < one.solver.final_cost) std::swap(one, other);
  one.other = other.motion;
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
