// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/plane_solver.h"

#include "engine/methods/plane/plane_weights.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

namespace gpo {
namespace {

constexpr int kUsualIterations = 16;
constexpr double kSettled = 1e-10;      // length of a step [rad, plane distances, rad/s]
constexpr double kRounding = 1e-12;     // relative change of the cost below rounding errors
constexpr int kMostHiddenSteps = 5;     // in a valley whose slope is below rounding errors
constexpr double kFirstDamping = 1e-4;  // relative to the diagonal, if Gauss-Newton fails
constexpr double kLargestDamping = 1e12;

/// Numbers of unknowns that all frames share and that each frame has.
template <int Shared, int Own>
struct Split {
  static constexpr int kShared = Shared;
  static constexpr int kOwn = Own;
};
using KnownRotations = Split<2, 3>;  // normal | t
using FreeRotations = Split<2, 6>;   // normal | phi, t
// `UnknownsLayout::size` shared unknowns; AnySharedFree also with gyroscope noise.
using AnyShared = Split<Eigen::Dynamic, 3>;
using AnySharedFree = Split<Eigen::Dynamic, 6>;

template <class S>
constexpr bool kNormalOnly = S::kShared == 2;
template <class S>
constexpr int kMost = kNormalOnly<S> ? 2 : kMostShared;

/// All frames linearized at a state.
template <class S>
struct Linearized {
  /// Normal equations of a frame's own unknowns.
  struct Frame {
    Eigen::Matrix<double, S::kShared, S::kOwn, 0, kMost<S>, S::kOwn> so;
    Eigen::Matrix<double, S::kOwn, S::kOwn> oo;
    Eigen::Matrix<double, S::kOwn, 1> o;
  };
  std::vector<Frame> frames;
  // Sums over the frames, with the priors.
  Eigen::Matrix<double, S::kShared, S::kShared, 0, kMost<S>, kMost<S>> ss;
  Eigen::Matrix<double, S::kShared, 1, 0, kMost<S>, 1> s;
  double cost = 0;
  bool in_front = true;
};

template <class S>
class PlaneProblem {
 public:
  using SharedVector = Eigen::Matrix<double, S::kShared, 1, 0, kMost<S>, 1>;
  using SharedMatrix = Eigen::Matrix<double, S::kShared, S::kShared, 0, kMost<S>, kMost<S>>;
  using OwnVector = Eigen::Matrix<double, S::kOwn, 1>;

  struct Step {
    SharedVector shared;
    std::vector<OwnVector> own;
    double length = 0;    ///< largest component
    double norm = 0;      ///< over all unknowns
    double decrease = 0;  ///< expected decrease of the cost
  };

  /// The solution for a frame's own unknowns is -(rest + gain shared).
  struct Eliminated {
    Eigen::Matrix<double, S::kOwn, S::kShared, 0, S::kOwn, kMost<S>> gain;
    OwnVector rest;
  };

  explicit PlaneProblem(const PlaneTask& task)
      : window_(task.window),
        observations_(task.observations),
        unknowns_(task.unknowns),
        layout_{static_cast<int>(observations_.others.size()),
                gyro_unknowns(window_, unknowns_.rotations)} {}

  int frame_count() const { return window_.frame_count(); }
  int unknown_count() const { return layout_.size() + S::kOwn * (frame_count() - 1); }

  /// Linearizes all frames; `all` provides the memory.
  void linearize(const PlaneMotion& motion, Linearized<S>& all) const {
    const Rotating rotating = S::kOwn == 6 || has_gyro() ? Rotating::yes : Rotating::no;
    const int size = layout_.size();
    all.ss.setZero(size, size);
    all.s.setZero(size);
    all.cost = 0;
    all.in_front = true;
    add_priors(motion, all);
    all.frames.resize(frame_count());
    for (int i = 1; i < frame_count(); ++i) {
      auto& frame = all.frames[i];
      frame.so.setZero(size, S::kOwn);
      frame.oo.setZero();
      frame.o.setZero();
      if (has_noise()) add_noise_prior(motion.gyro_noise_rad[i], i, frame, all);
      for (int k = 0; k < observations_.plane_count(); ++k) {
        const FrameState state = frame_state(observations_, motion, i, k);
        const FrameNormals f = weighted_normals(observations_.plane(k)[i], state, rotating);
        frame.oo += f.JtJ.template bottomRightCorner<S::kOwn, S::kOwn>();
        frame.o += f.Jtr.template tail<S::kOwn>();
        all.cost += f.cost;
        all.in_front = all.in_front && f.in_front;
        if constexpr (kNormalOnly<S>) {
          all.ss += f.JtJ.topLeftCorner<2, 2>();
          all.s += f.Jtr.head<2>();
          frame.so += f.JtJ.topRightCorner<2, S::kOwn>();
        } else {
          const auto gyro = gyro_columns(window_, motion, i, layout_.gyro);
          add_plane(f, k, plane_columns(k, state.tau_c, gyro), frame, all);
        }
      }
    }
  }

  /// Returns the damped Gauss-Newton step: eliminates the own unknowns, solves for the shared ones
  /// and substitutes back.
  Step step(const Linearized<S>& at, double damping) const {
    SharedMatrix reduced = at.ss;
    reduced.diagonal() *= 1 + damping;
    SharedVector right = at.s;
    std::vector<Eliminated> frames(frame_count());
    for (int i = 1; i < frame_count(); ++i) {
      const auto& f = at.frames[i];
      Eigen::Matrix<double, S::kOwn, S::kOwn> oo = f.oo;
      oo.diagonal() *= 1 + damping;
      const Eigen::LLT<Eigen::Matrix<double, S::kOwn, S::kOwn>> factor(oo);
      auto& [gain, rest] = frames[i];
      gain.resize(S::kOwn, at.s.size());
      // Column by column, which Eigen unrolls, and without its products for large matrices.
      for (int c = 0; c < gain.cols(); ++c)
        gain.col(c) = factor.solve(OwnVector(f.so.row(c).transpose()));
      rest = factor.solve(f.o);
      reduced -= f.so.lazyProduct(gain);
      right -= f.so.lazyProduct(rest);
    }
    Step step;
    step.shared = reduced.llt().solve(-right);
    step.length = step.shared.cwiseAbs().maxCoeff();
    double squares = step.shared.squaredNorm();
    step.decrease = -0.5 * at.s.dot(step.shared);
    step.own.assign(frame_count(), OwnVector::Zero());
    for (int i = 1; i < frame_count(); ++i) {
      step.own[i] = -(frames[i].rest + frames[i].gain * step.shared);
      step.length = std::max(step.length, step.own[i].cwiseAbs().maxCoeff());
      step.decrease -= 0.5 * at.frames[i].o.dot(step.own[i]);
      squares += step.own[i].squaredNorm();
    }
    step.norm = std::sqrt(squares);
    return step;
  }

  /// Returns the largest component of the cost's gradient.
  double gradient(const Linearized<S>& at) const {
    double largest = at.s.cwiseAbs().maxCoeff();
    for (int i = 1; i < frame_count(); ++i)
      largest = std::max(largest, at.frames[i].o.cwiseAbs().maxCoeff());
    return largest;
  }

  PlaneMotion moved(const PlaneMotion& from, const Step& step) const {
    PlaneMotion to = from;
    move_shared(layout_, step.shared, to);
    for (int i = 1; i < frame_count(); ++i) move_frame(window_, layout_.gyro, i, step.own[i], to);
    return to;
  }

 private:
  // False at compile time if the split has no such unknowns.
  bool has_gyro() const { return !kNormalOnly<S> && layout_.gyro > 0; }
  bool has_noise() const { return !kNormalOnly<S> && S::kOwn == 6 && unknowns_.gyro_noise; }

  /// Adds the shared unknowns of one plane.
  void add_plane(const FrameNormals& f,
                 int plane,
                 const PlaneColumns& M,
                 typename Linearized<S>::Frame& frame,
                 Linearized<S>& all) const {
    const Eigen::Matrix<double, 8, Eigen::Dynamic, 0, 8, 7> FM = f.JtJ.lazyProduct(M);
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 7, 7> MFM =
        M.transpose().lazyProduct(FM);
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 7, 1> Mr = M.transpose().lazyProduct(f.Jtr);
    const int p = UnknownsLayout::of_plane(plane);
    const int n = UnknownsLayout::size_of_plane(plane);
    const int g = layout_.of_gyro();
    const int b = layout_.gyro;
    all.ss.block(p, p, n, n) += MFM.topLeftCorner(n, n);
    all.ss.block(p, g, n, b) += MFM.topRightCorner(n, b);
    all.ss.block(g, p, b, n) += MFM.bottomLeftCorner(b, n);
    all.ss.block(g, g, b, b) += MFM.bottomRightCorner(b, b);
    all.s.segment(p, n) += Mr.head(n);
    all.s.segment(g, b) += Mr.tail(b);
    frame.so.middleRows(p, n) += FM.leftCols(n).template bottomRows<S::kOwn>().transpose();
    frame.so.middleRows(g, b) += FM.rightCols(b).template bottomRows<S::kOwn>().transpose();
  }

  void add_priors(const PlaneMotion& motion, Linearized<S>& all) const {
    const GyroVector sigmas = gyro_prior_sigmas(window_, layout_.gyro);
    const GyroVector errors = gyro_prior_errors(window_, layout_.gyro, motion);
    for (int k = 0; k < layout_.gyro; ++k) {
      const int at = layout_.of_gyro() + k;
      const double weight = prior_weight(unknowns_.sigma_px, sigmas(k));
      all.ss(at, at) += weight;
      all.s(at) += weight * errors(k);
      all.cost += 0.5 * weight * errors(k) * errors(k);
    }
  }

  void add_noise_prior(const Eigen::Vector3d& noise_rad,
                       int frame,
                       typename Linearized<S>::Frame& own,
                       Linearized<S>& all) const {
    const double weight = prior_weight(unknowns_.sigma_px, gyro_noise_sigma_rad(window_, frame));
    own.oo.diagonal().template head<3>().array() += weight;
    own.o.template head<3>() += weight * noise_rad;
    all.cost += 0.5 * weight * noise_rad.squaredNorm();
  }

  const Window& window_;
  const PlaneObservations& observations_;
  const PlaneUnknowns& unknowns_;
  const UnknownsLayout layout_;
};

template <class S>
PlaneSolution minimize(const PlaneTask& task,
                       const PlaneMotion& start,
                       const Watch& watch,
                       int most_steps) {
  const PlaneProblem<S> problem(task);
  PlaneSolution solution{start, {}};
  SolverReport& report = solution.solver;
  report.unknowns = problem.unknown_count();
  report.termination = Termination::no_convergence;
  Linearized<S> at, there;
  problem.linearize(start, at);
  report.initial_cost = at.cost;
  if (!at.in_front || !std::isfinite(at.cost)) report.termination = Termination::failure;
  report.trace.reserve(kUsualIterations);
  report.trace.push_back({at.cost, problem.gradient(at), 0, start.normal});
  double damping = 0;
  int hidden_steps = 0, taken = 0;
  while (report.termination == Termination::no_convergence && taken < most_steps &&
         report.iterations < kMostSteps && !watch.stop_requested()) {
    ++report.iterations;
    const auto step = problem.step(at, damping);
    PlaneMotion moved = problem.moved(solution.motion, step);
    problem.linearize(moved, there);
    // Close to the minimum the cost's rounding errors exceed its decrease: accept the step.
    const bool hidden = std::abs(step.decrease) < kRounding * at.cost;
    const bool better = there.in_front && (there.cost <= at.cost || hidden);
    hidden_steps += hidden ? 1 : 0;
    const bool settled = step.length < kSettled || hidden_steps == kMostHiddenSteps;
    if (better) {
      ++taken;
      solution.motion = std::move(moved);
      std::swap(at, there);
      damping = damping > kFirstDamping ? damping / 10 : 0;
      report.trace.push_back({at.cost, problem.gradient(at), step.norm, solution.motion.normal});
    } else {
      damping = std::max(10 * damping, kFirstDamping);
      report.trace.push_back(report.trace.back());
      report.trace.back().step = 0;
    }
    watch.report(report.iterations, at.cost);
    if (settled) report.termination = Termination::convergence;
    if (!(damping < kLargestDamping)) report.termination = Termination::failure;
  }
  report.final_cost = at.cost;
  return solution;
}

/// Counts the gyroscope's rotations as measurements if its noise is an unknown.
int residual_count(const PlaneTask& task) {
  const int frames = static_cast<int>(task.observations.frames.size());
  return 2 * task.observations.count() + (task.unknowns.gyro_noise ? 3 * (frames - 1) : 0);
}

}  // namespace

PlaneMotion with_noise_unknowns(PlaneMotion start, const PlaneUnknowns& unknowns) {
  if (!unknowns.gyro_noise) start.gyro_noise_rad.clear();
  if (unknowns.gyro_noise && start.gyro_noise_rad.empty())
    start.gyro_noise_rad.assign(start.tau.size(), Eigen::Vector3d::Zero());
  return start;
}

PlaneSolution solve_plane(const PlaneTask& task,
                          const PlaneMotion& start,
                          const Watch& watch,
                          int most_steps) {
  const auto begin = std::chrono::steady_clock::now();
  const PlaneUnknowns& unknowns = task.unknowns;
  const bool free = unknowns.rotations == RotationModel::free || unknowns.gyro_noise;
  const bool normal_only = task.observations.others.empty() && !unknowns.gyro_noise &&
                           unknowns.rotations != RotationModel::bias;
  const auto solve = normal_only ? (free ? minimize<FreeRotations> : minimize<KnownRotations>)
                     : free      ? minimize<AnySharedFree>
                                 : minimize<AnyShared>;
  PlaneSolution solution = solve(task, with_noise_unknowns(start, unknowns), watch, most_steps);
  solution.solver.residuals = residual_count(task);
  solution.solver.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return solution;
}

}  // namespace gpo
