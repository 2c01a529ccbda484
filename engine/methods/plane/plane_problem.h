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

/// Normal equations of a frame, split into shared and own unknowns.
template <class S>
struct SplitNormals {
  Eigen::Matrix<double, S::kShared, S::kShared, 0, kMost<S>, kMost<S>> ss;
  Eigen::Matrix<double, S::kShared, S::kOwn, 0, kMost<S>, S::kOwn> so;
  Eigen::Matrix<double, S::kOwn, S::kOwn> oo;
  Eigen::Matrix<double, S::kShared, 1, 0, kMost<S>, 1> s;
  Eigen::Matrix<double, S::kOwn, 1> o;
};

template <class S>
SplitNormals<S> split(const FrameNormals& f) {
  return {f.JtJ.topLeftCorner<2, 2>(),
          f.JtJ.topRightCorner<2, S::kOwn>(),
          f.JtJ.bottomRightCorner<S::kOwn, S::kOwn>(),
          f.Jtr.head<2>(),
          f.Jtr.tail<S::kOwn>()};
}

/// Adds the normal equations of one plane.
template <class S>
void add_plane(const FrameNormals& f,
               const UnknownsLayout& layout,
               int plane,
               const PlaneColumns& M,
               SplitNormals<S>& sum) {
  const Eigen::Matrix<double, 8, Eigen::Dynamic, 0, 8, 7> FM = f.JtJ * M;
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 7, 7> MFM = M.transpose() * FM;
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 7, 1> Mr = M.transpose() * f.Jtr;
  const int p = UnknownsLayout::of_plane(plane);
  const int n = UnknownsLayout::size_of_plane(plane);
  const int g = layout.of_gyro();
  const int b = layout.gyro;
  sum.ss.block(p, p, n, n) += MFM.topLeftCorner(n, n);
  sum.ss.block(p, g, n, b) += MFM.topRightCorner(n, b);
  sum.ss.block(g, p, b, n) += MFM.bottomLeftCorner(b, n);
  sum.ss.block(g, g, b, b) += MFM.bottomRightCorner(b, b);
  sum.so.middleRows(p, n) += FM.leftCols(n).template bottomRows<S::kOwn>().transpose();
  sum.so.middleRows(g, b) += FM.rightCols(b).template bottomRows<S::kOwn>().transpose();
  sum.oo += f.JtJ.template bottomRightCorner<S::kOwn, S::kOwn>();
  sum.s.segment(p, n) += Mr.head(n);
  sum.s.segment(g, b) += Mr.tail(b);
  sum.o += f.Jtr.template tail<S::kOwn>();
}

/// All frames linearized at a state.
struct Linearized {
  std::vector<std::vector<FrameNormals>> planes;  ///< main plane first; one per frame
  double cost = 0;                                ///< including the priors
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
    OwnVector gradient;
  };

  explicit PlaneProblem(const PlaneTask& task)
      : window_(task.window),
        observations_(task.observations),
        unknowns_(task.unknowns),
        layout_{static_cast<int>(observations_.others.size()),
                unknowns_.rotations != RotationModel::bias ? 0
                : unknowns_.time_offset                    ? 4
                                                           : 3} {}

  int frame_count() const { return window_.frame_count(); }
  int unknown_count() const { return layout_.size() + S::kOwn * (frame_count() - 1); }

  Linearized linearize(const PlaneMotion& motion) const {
    const Rotating rotating = S::kOwn == 6 || has_gyro() ? Rotating::yes : Rotating::no;
    Linearized all;
    all.planes.resize(observations_.plane_count(), std::vector<FrameNormals>(frame_count()));
    all.cost = prior_cost(motion);
    for (int i = 1; i < frame_count(); ++i) {
      for (int k = 0; k < observations_.plane_count(); ++k) {
        const FrameState state = frame_state(observations_, motion, i, k);
        const FrameNormals& normals = all.planes[k][i] =
            weighted_normals(observations_.plane(k)[i], state, rotating);
        all.cost += normals.cost;
        all.in_front = all.in_front && normals.in_front;
      }
    }
    return all;
  }

  /// Returns the damped Gauss-Newton step: eliminates the own unknowns, solves for the shared ones
  /// and substitutes back.
  Step step(const Linearized& at, const PlaneMotion& motion, double damping) const {
    SharedMatrix reduced = SharedMatrix::Zero(layout_.size(), layout_.size());
    SharedVector right = SharedVector::Zero(layout_.size());
    add_priors(motion, reduced, right);
    SharedVector gradient = right;
    SharedVector diagonal = reduced.diagonal();
    std::vector<Eliminated> frames(frame_count());
    for (int i = 1; i < frame_count(); ++i) {
      SplitNormals<S> f = split_frame(at, motion, i);
      f.oo.diagonal() *= 1 + damping;
      const Eigen::LLT<Eigen::Matrix<double, S::kOwn, S::kOwn>> factor(f.oo);
      frames[i] = {factor.solve(f.so.transpose()), factor.solve(f.o), f.o};
      reduced += f.ss - f.so * frames[i].gain;
      right += f.s - f.so * frames[i].rest;
      gradient += f.s;
      diagonal += f.ss.diagonal();
    }
    reduced.diagonal() += damping * diagonal;
    Step step;
    step.shared = reduced.llt().solve(-right);
    step.length = step.shared.cwiseAbs().maxCoeff();
    double squares = step.shared.squaredNorm();
    step.decrease = -0.5 * gradient.dot(step.shared);
    step.own.assign(frame_count(), OwnVector::Zero());
    for (int i = 1; i < frame_count(); ++i) {
      step.own[i] = -(frames[i].rest + frames[i].gain * step.shared);
      step.length = std::max(step.length, step.own[i].cwiseAbs().maxCoeff());
      step.decrease -= 0.5 * frames[i].gradient.dot(step.own[i]);
      squares += step.own[i].squaredNorm();
    }
    step.norm = std::sqrt(squares);
    return step;
  }

  /// Returns the largest component of the cost's gradient.
  double gradient(const Linearized& at, const PlaneMotion& motion) const {
    SharedVector shared = prior_gradient(motion);
    double largest = 0;
    for (int i = 1; i < frame_count(); ++i) {
      if constexpr (kNormalOnly<S>) {
        const FrameNormals& f = at.planes[0][i];
        shared += f.Jtr.head<2>();
        largest = std::max(largest, f.Jtr.tail<S::kOwn>().cwiseAbs().maxCoeff());
      } else {
        const SplitNormals<S> f = split_frame(at, motion, i);
        shared += f.s;
        largest = std::max(largest, f.o.cwiseAbs().maxCoeff());
      }
    }
    return std::max(largest, shared.cwiseAbs().maxCoeff());
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

  SplitNormals<S> split_frame(const Linearized& at, const PlaneMotion& motion, int frame) const {
    if constexpr (kNormalOnly<S>) {
      return split<S>(at.planes[0][frame]);
    } else {
      const int size = layout_.size();
      SplitNormals<S> sum;
      sum.ss.setZero(size, size);
      sum.so.setZero(size, S::kOwn);
      sum.oo.setZero();
      sum.s.setZero(size);
      sum.o.setZero();
      const auto gyro = gyro_columns(window_, motion, frame, layout_.gyro);
      const Eigen::Vector3d tau_c = motion.R_wc[frame].transpose() * motion.tau[frame];
      for (int k = 0; k <= layout_.others; ++k)
        add_plane<S>(at.planes[k][frame], layout_, k, plane_columns(k, tau_c, gyro), sum);
      if (has_noise()) {
        sum.oo.diagonal().template head<3>().array() += noise_weight(frame);
        sum.o.template head<3>() += noise_weight(frame) * motion.gyro_noise_rad[frame];
      }
      return sum;
    }
  }

  double prior_cost(const PlaneMotion& motion) const {
    double cost = 0;
    if (has_gyro())
      cost += 0.5 * bias_weight() * (motion.bias_rad_s - window_.gyro->prior_rad_s).squaredNorm();
    if (has_clock()) cost += 0.5 * offset_weight() * motion.time_offset_s * motion.time_offset_s;
    for (int i = 1; has_noise() && i < frame_count(); ++i)
      cost += 0.5 * noise_weight(i) * motion.gyro_noise_rad[i].squaredNorm();
    return cost;
  }

  SharedVector prior_gradient(const PlaneMotion& motion) const {
    SharedVector gradient = SharedVector::Zero(layout_.size());
    if (has_gyro()) {
      gradient.template segment<3>(layout_.of_gyro()) =
          bias_weight() * (motion.bias_rad_s - window_.gyro->prior_rad_s);
    }
    if (has_clock()) gradient(layout_.of_gyro() + 3) = offset_weight() * motion.time_offset_s;
    return gradient;
  }

  void add_priors(const PlaneMotion& motion, SharedMatrix& JtJ, SharedVector& Jtr) const {
    const int g = layout_.of_gyro();
    if (has_gyro()) JtJ.diagonal().template segment<3>(g).array() += bias_weight();
    if (has_clock()) JtJ(g + 3, g + 3) += offset_weight();
    Jtr += prior_gradient(motion);
  }

  double bias_weight() const {
    return prior_weight(unknowns_.sigma_px, window_.gyro->prior_sigma_rad_s);
  }
  double noise_weight(int frame) const {
    return prior_weight(unknowns_.sigma_px, gyro_noise_sigma_rad(window_, frame));
  }
  double offset_weight() const { return prior_weight(unknowns_.sigma_px, kTimeOffsetSigma_s); }

  const Window& window_;
  const PlaneObservations& observations_;
  const PlaneUnknowns& unknowns_;
  const UnknownsLayout layout_;
};

}  // namespace gpo
