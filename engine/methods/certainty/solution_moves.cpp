// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/solution_moves.h"

#include "engine/methods/plane/plane_weights.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gpo {
namespace {

/// By how much the errors of a frame's observations change with one parameter of the lens [px].
Eigen::Matrix2Xd lens_errors_px(const Window& window,
                                const FrameObservations& f,
                                const FrameState& state,
                                int frame,
                                std::size_t parameter) {
  const std::vector<Eigen::Matrix2Xd>& moves = window.lens_moves_px[parameter];
  FrameObservations moved = f;
  Eigen::Matrix2Xd errors(2, f.count);
  for (int o = 0; o < f.count; ++o) {
    const int j = f.track[o];
    moved.ray_x[o] += moves[0](0, j) / state.fx;
    moved.ray_y[o] += moves[0](1, j) / state.fy;
    moved.u[o] += moves[frame](0, j);
    moved.v[o] += moves[frame](1, j);
    errors.col(o) = transfer_error_px(moved, state, o) - transfer_error_px(f, state, o);
  }
  return errors;
}

using Moves = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// How the walk of a gyroscope, in the world's axes, moves the solution.
struct WalkMoves {
  std::vector<OwnMatrix> own;  // of each frame's noise
  std::vector<Moves> later;    // what is shared, of a step that turns this frame and all later ones
};

// What a step of the walk turns, it turns in all later frames: there its axes are R_wc^T of the
// world's. A frame whose noise is phi moves the solution by the prior's weight times it.
WalkMoves walk_moves(const PlaneMotion& motion,
                     const Bread& bread,
                     const SharedMatrix& shared_inverse) {
  const int frames = static_cast<int>(motion.tau.size());
  WalkMoves walk{std::vector<OwnMatrix>(frames),
                 std::vector<Moves>(frames + 1, Moves::Zero(shared_inverse.rows(), 3))};
  for (int i = frames - 1; i > 0; --i) {
    const Eigen::Matrix3d turn = bread.noise_weights[i] * motion.R_wc[i].transpose();
    walk.own[i] = -bread.frames[i].inverse.leftCols<3>() * turn;
    const SharedMatrix pull = bread.frames[i].gain.topRows<3>().transpose() * turn;
    walk.later[i] = walk.later[i + 1] + shared_inverse * pull;
  }
  return walk;
}

}  // namespace

std::vector<SolutionMove> moves_by_gyro_noise(const Window& window,
                                              const PlaneMotion& motion,
                                              const Bread& bread,
                                              const SharedMatrix& shared_inverse) {
  std::vector<SolutionMove> moves;
  if (bread.noise_weights.empty()) return moves;
  const WalkMoves walk = walk_moves(motion, bread, shared_inverse);
  const int frames = static_cast<int>(motion.tau.size());
  const OwnVector none = OwnVector::Zero(bread.frames[1].inverse.rows());
  double before = 0;
  for (int k = 1; k < frames; ++k) {
    const double sigma = gyro_noise_sigma_rad(window, k);
    const double step = std::sqrt(std::max(0.0, sigma * sigma - before));
    before = sigma * sigma;
    for (int axis = 0; axis < 3; ++axis) {
      SolutionMove move{step * walk.later[k].col(axis), {motion.tau.size(), none}};
      for (int i = k; i < frames; ++i) move.own[i] = step * walk.own[i].col(axis);
      moves.push_back(std::move(move));
    }
  }
  return moves;
}

void add_gyro_noise(const Window& window,
                    const PlaneMotion& motion,
                    const Bread& bread,
                    const SharedMatrix& shared_inverse,
                    Spread& spread) {
  if (bread.noise_weights.empty()) return;
  const int frames = static_cast<int>(motion.tau.size());
  const auto [own, later] = walk_moves(motion, bread, shared_inverse);
  SharedMatrix walked = Moves::Zero(shared_inverse.rows(), 3);
  double before = 0;
  for (int i = 1; i < frames; ++i) {
    const double sigma = gyro_noise_sigma_rad(window, i);
    const double variance = sigma * sigma;
    walked += (variance - before) * later[i];
    spread.shared += (variance - before) * later[i] * later[i].transpose();
    spread.cross[i] += walked * own[i].transpose();
    spread.own[i] += variance * own[i] * own[i].transpose();
    before = variance;
  }
}

SolutionMove move_by_lens(const Window& window,
                          const PlaneObservations& observations,
                          const PlaneMotion& motion,
                          const Bread& bread,
                          const SharedMatrix& shared_inverse,
                          std::size_t parameter) {
  const int frames = static_cast<int>(motion.tau.size());
  const auto own = bread.frames[1].inverse.rows();
  Eigen::VectorXd reduced = Eigen::VectorXd::Zero(bread.layout.size());
  std::vector<OwnVector> of_frame(frames, OwnVector::Zero(own));
  for (int i = 1; i < frames; ++i) {
    for (std::size_t k = 0; k < bread.columns.size(); ++k) {
      const int plane = static_cast<int>(k);
      const FrameObservations& f = of_plane(observations, plane)[i];
      const FrameState state = state_of(observations, motion, i, plane);
      const Eigen::Matrix2Xd errors = lens_errors_px(window, f, state, i, parameter);
      const FrameObservations curved = curvature_weights(f, state).value_or(f);
      Eigen::Matrix<double, 8, 1> g = Eigen::Matrix<double, 8, 1>::Zero();
      for (int o = 0; o < f.count; ++o) g += gradient_of(curved, state, o, errors.col(o));
      reduced(bread.places(plane)) += bread.columns[k][i].transpose() * g;
      of_frame[i] += g.tail(own);
    }
    reduced -= bread.frames[i].gain.transpose() * of_frame[i];
  }
  for (int i = 1; i < frames; ++i) of_frame[i] = -(bread.frames[i].inverse * of_frame[i]).eval();
  return {-(shared_inverse * reduced), std::move(of_frame)};
}

void add_lens(const Window& window,
              const PlaneObservations& observations,
              const PlaneMotion& motion,
              const Bread& bread,
              const SharedMatrix& shared_inverse,
              Spread& spread) {
  for (std::size_t p = 0; p < window.lens_moves_px.size(); ++p) {
    const auto [x, e] = move_by_lens(window, observations, motion, bread, shared_inverse, p);
    spread.shared += x * x.transpose();
    for (std::size_t i = 1; i < motion.tau.size(); ++i) {
      spread.cross[i] += x * e[i].transpose();
      spread.own[i] += e[i] * e[i].transpose();
    }
  }
}

}  // namespace gpo
