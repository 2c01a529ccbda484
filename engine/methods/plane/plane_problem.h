// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Normal equations of plane_solver.cpp, with the unknowns of each frame eliminated.
#pragma once

#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/plane_weights.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

namespace gpo {

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
void add_normals(const FrameNormals& f, typename Linearized<S>::Frame& frame, Linearized<S>& sum) {
  frame.oo += f.JtJ.template bottomRightCorner<S::kOwn, S::kOwn>();
  frame.o += f.Jtr.template tail<S::kOwn>();
  sum.cost += f.cost;
  sum.in_front = sum.in_front && f.in_front;
}

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
        add_normals<S>(f, frame, all);
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
    to.normal = moved_normal(from.normal, step.shared.template head<2>());
    for (int k = 0; !kNormalOnly<S> && k < layout_.others; ++k) {
      const Eigen::Vector3d u_s = step.shared.segment(UnknownsLayout::of_plane(k + 1), 3);
      const double length = from.others[k].m.norm();
      to.others[k].m =
          length * std::exp(u_s(2)) * moved_normal(from.others[k].m / length, u_s.head<2>());
    }
    if (has_gyro()) to.bias_rad_s += step.shared.template segment<3>(layout_.of_gyro());
    if (has_clock()) to.time_offset_s += step.shared(layout_.of_gyro() + 3);
    for (int i = 1; i < frame_count(); ++i) {
      to.tau[i] += from.R_wc[i] * step.own[i].template tail<3>();
      if constexpr (S::kOwn == 6) {
        const Eigen::Matrix3d turn = so3_exp(step.own[i].template head<3>());
        if (has_noise()) {
          to.gyro_noise_rad[i] = so3_log(so3_exp(from.gyro_noise_rad[i]) * turn);
        } else {
          to.R_wc[i] = from.R_wc[i] * turn;
        }
      }
      if (has_gyro()) to.R_wc[i] = gyro_rotation(window_, i, to);
    }
    return to;
  }

 private:
  // False at compile time if the split has no such unknowns.
  bool has_gyro() const { return !kNormalOnly<S> && layout_.gyro > 0; }
  bool has_noise() const { return !kNormalOnly<S> && S::kOwn == 6 && unknowns_.gyro_noise; }
  bool has_clock() const { return !kNormalOnly<S> && layout_.gyro == 4; }

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
    const int g = layout_.of_gyro();
    if (has_gyro()) {
      const Eigen::Vector3d error = motion.bias_rad_s - window_.gyro->prior_rad_s;
      all.ss.diagonal().template segment<3>(g).array() += bias_weight();
      all.s.template segment<3>(g) += bias_weight() * error;
      all.cost += 0.5 * bias_weight() * error.squaredNorm();
    }
    if (has_clock()) {
      all.ss(g + 3, g + 3) += offset_weight();
      all.s(g + 3) += offset_weight() * motion.time_offset_s;
      all.cost += 0.5 * offset_weight() * motion.time_offset_s * motion.time_offset_s;
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

  double bias_weight() const {
    return prior_weight(unknowns_.sigma_px, window_.gyro->prior_sigma_rad_s);
  }
  double offset_weight() const {
    return prior_weight(unknowns_.sigma_px, window_.gyro->time_offset_sigma_s);
  }

  const Window& window_;
  const PlaneObservations& observations_;
  const PlaneUnknowns& unknowns_;
  const UnknownsLayout layout_;
};

}  // namespace gpo
