// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/uncertainty/shares.h"

#include "engine/methods/plane/plane_weights.h"
#include "engine/methods/uncertainty/information.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace gpo {
namespace {

/// Returns the change of a frame's errors by one standard deviation of each lens parameter, in
/// columns [px].
Eigen::MatrixXd lens_errors_px(LensMoves moves_px,
                               const FrameObservations& f,
                               const FrameState& state,
                               int frame) {
  Eigen::MatrixXd errors(2 * f.count, std::ssize(moves_px));
  for (int o = 0; o < f.count; ++o) {
    const Eigen::Vector3d ray(f.ray_x[o], f.ray_y[o], 1);
    const Eigen::Vector2d pixel = transfer_on_plane(state, ray).pixel;
    for (Eigen::Index p = 0; p < errors.cols(); ++p) {
      const auto move_px = moves_px[p][0].col(f.track[o]);
      const Eigen::Vector3d moved =
          ray + Eigen::Vector3d(move_px.x() / state.fx, move_px.y() / state.fy, 0);
      errors.col(p).segment<2>(Eigen::Index{2} * o) =
          transfer_on_plane(state, moved).pixel - pixel - moves_px[p][frame].col(f.track[o]);
    }
  }
  return errors;
}

using Moves = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Displacements by the gyroscope's random walk in world axes.
struct WalkMoves {
  std::vector<OwnMatrix> own;  ///< by the noise of each frame
  std::vector<Moves> later;    ///< shared unknowns, by a step in this and all later frames
};

// A step of the walk rotates all later frames; its axes in a frame are R_wc^T of the world's. Noise
// phi of a frame displaces the solution by the prior's weight times phi.
WalkMoves walk_moves(const Sandwich& sandwich) {
  const auto& [solved, bread, inverse] = sandwich;
  const int frames = solved.frame_count();
  WalkMoves walk{std::vector<OwnMatrix>(frames),
                 std::vector<Moves>(frames + 1, Moves::Zero(inverse.rows(), 3))};
  for (int i = frames - 1; i > 0; --i) {
    const Eigen::Matrix3d turn = bread.noise_weights[i] * solved.motion.R_wc[i].transpose();
    walk.own[i] = -bread.frames[i].inverse.leftCols<3>() * turn;
    const SharedMatrix pull = bread.frames[i].gain.topRows<3>().transpose() * turn;
    walk.later[i] = walk.later[i + 1] + inverse * pull;
  }
  return walk;
}

struct ResultMoves {
  Eigen::MatrixXd results;  ///< displacements of (centers, gyroscope, planes), in columns
  Eigen::MatrixXd shared;   ///< displacements of the shared unknowns
};

ResultMoves moves_of_results(const PlaneMotion& motion,
                             const Eigen::MatrixXd& M,
                             std::span<const SolutionMove> moves) {
  ResultMoves all{Eigen::MatrixXd::Zero(M.rows(), std::ssize(moves)),
                  Eigen::MatrixXd(M.cols(), std::ssize(moves))};
  for (Eigen::Index k = 0; k < std::ssize(moves); ++k) {
    all.shared.col(k) = moves[k].shared;
    for (Eigen::Index i = 1; i < std::ssize(motion.tau); ++i)
      all.results.col(k).segment<3>(3 * (i - 1)) = -motion.R_wc[i] * moves[k].own[i].tail<3>();
  }
  all.results += M * all.shared;
  return all;
}

/// Returns the displacements by each observed track, weighted so that the sums of squares are those
/// of `spread_of`.
ResultMoves moves_by_track(const Sandwich& sandwich,
                           const Eigen::MatrixXd& M,
                           const Influences& all,
                           double degrees_of_freedom) {
  std::vector<int> place(sandwich.solved.window.track_count(), -1);
  int tracks = 0;
  for (const int track : all.track)
    if (place[track] < 0) place[track] = tracks++;
  const double weight = std::sqrt(degrees_of_freedom * tracks / std::max(1.0, tracks - 1.0));
  ResultMoves moves{Eigen::MatrixXd::Zero(M.rows(), tracks),
                    Eigen::MatrixXd::Zero(M.cols(), tracks)};
  for (Eigen::Index i = 1; i < sandwich.solved.frame_count(); ++i) {
    for (Eigen::Index o = all.first[i]; o < all.first[i + 1]; ++o) {
      const int track = place[all.track[o]];
      moves.shared.col(track) += weight * all.shared.col(o);
      moves.results.col(track).segment<3>(3 * (i - 1)) -=
          weight * (sandwich.solved.motion.R_wc[i] * all.own.col(o).tail<3>());
    }
  }
  moves.results += M * moves.shared;
  return moves;
}

/// Returns the covariance of the results for independent errors of all observations.
Eigen::MatrixXd covariance_by_observation(const PlaneMotion& motion,
                                          const Eigen::MatrixXd& M,
                                          const Influences& all,
                                          double degrees_of_freedom) {
  Eigen::MatrixXd covariance = M * (all.shared * all.shared.transpose()) * M.transpose();
  for (Eigen::Index i = 1; i < std::ssize(motion.tau); ++i) {
    const auto columns = Eigen::seq(all.first[i], all.first[i + 1] - 1);
    const Eigen::MatrixXd e = motion.R_wc[i] * all.own(Eigen::all, columns).bottomRows<3>();
    const Eigen::Index at = 3 * (i - 1);
    const Eigen::MatrixXd cross = -M * (all.shared(Eigen::all, columns) * e.transpose());
    covariance.middleCols<3>(at) += cross;
    covariance.middleRows<3>(at) += cross.transpose();
    covariance.block<3, 3>(at, at) += e * e.transpose();
  }
  return degrees_of_freedom * covariance;
}

/// Returns J^T, over (u, phi, t), times the second derivative of the loss, two columns for each
/// observation of a frame.
Eigen::Matrix<double, 8, Eigen::Dynamic> curved_jacobian(const FrameObservations& f,
                                                         const FrameState& state) {
  Eigen::Matrix<double, 8, Eigen::Dynamic> all(8, 2 * f.count);
  for (int k = 0; k < f.count; ++k) {
    const Transfer transfer = transfer_of(f, state, k);
    const Eigen::Vector2d r = transfer.pixel - Eigen::Vector2d(f.u[k], f.v[k]);
    all.middleCols<2>(Eigen::Index{2} * k).noalias() =
        transfer.jacobian(state.tangents).transpose() * curvature_of(f, k, r);
  }
  return all;
}

}  // namespace

// p_wc = -tau with tau_i + R_wci t, t = -gain x.
Eigen::MatrixXd results_by_shared(const PlaneMotion& motion, const Bread& bread) {
  const auto frames = std::ssize(motion.tau);
  const int gyro = bread.layout.gyro;
  const int of_planes = bread.layout.of_gyro();
  Eigen::MatrixXd M =
      Eigen::MatrixXd::Zero(3 * (frames - 1) + gyro + of_planes, bread.layout.size());
  for (Eigen::Index i = 1; i < frames; ++i)
    M.middleRows<3>(3 * (i - 1)) = motion.R_wc[i] * bread.frames[i].gain.bottomRows<3>();
  M.block(3 * (frames - 1), of_planes, gyro, gyro).setIdentity();
  M.bottomLeftCorner(of_planes, of_planes).setIdentity();
  return M;
}

std::vector<SolutionMove> moves_by_gyro_noise(const Sandwich& sandwich) {
  std::vector<SolutionMove> moves;
  if (sandwich.bread.noise_weights.empty()) return moves;
  const WalkMoves walk = walk_moves(sandwich);
  const int frames = sandwich.solved.frame_count();
  const OwnVector none = OwnVector::Zero(sandwich.bread.frames[1].inverse.rows());
  double before = 0;
  for (int k = 1; k < frames; ++k) {
    const double sigma = gyro_noise_sigma_rad(sandwich.solved.window, k);
    const double step = std::sqrt(std::max(0.0, sigma * sigma - before));
    before = sigma * sigma;
    for (int axis = 0; axis < 3; ++axis) {
      SolutionMove move{step * walk.later[k].col(axis),
                        std::vector<OwnVector>(static_cast<std::size_t>(frames), none)};
      for (int i = k; i < frames; ++i) move.own[i] = step * walk.own[i].col(axis);
      moves.push_back(std::move(move));
    }
  }
  return moves;
}

void add_gyro_noise(const Sandwich& sandwich, Spread& spread) {
  if (sandwich.bread.noise_weights.empty()) return;
  const auto [own, later] = walk_moves(sandwich);
  SharedMatrix walked = Moves::Zero(sandwich.inverse.rows(), 3);
  double before = 0;
  for (int i = 1; i < sandwich.solved.frame_count(); ++i) {
    const double sigma = gyro_noise_sigma_rad(sandwich.solved.window, i);
    const double variance = sigma * sigma;
    walked += (variance - before) * later[i];
    spread.shared += (variance - before) * later[i] * later[i].transpose();
    spread.cross[i] += walked * own[i].transpose();
    spread.own[i] += variance * own[i] * own[i].transpose();
    before = variance;
  }
}

std::vector<SolutionMove> moves_by_lens(const Sandwich& sandwich, LensMoves moves_px) {
  const auto& [solved, bread, inverse] = sandwich;
  const int frames = solved.frame_count();
  const auto own = bread.frames[1].inverse.rows();
  const auto count = std::ssize(moves_px);
  Eigen::MatrixXd reduced = Eigen::MatrixXd::Zero(bread.layout.size(), count);
  std::vector<Eigen::MatrixXd> of_frame(frames, Eigen::MatrixXd::Zero(own, count));
  for (int i = 1; i < frames; ++i) {
    for (int k = 0; k < std::ssize(bread.columns); ++k) {
      const FrameObservations& f = solved.observations.plane(k)[i];
      const FrameState state = frame_state(solved.observations, solved.motion, i, k);
      const Eigen::MatrixXd g = curved_jacobian(f, state) * lens_errors_px(moves_px, f, state, i);
      reduced(bread.places(k), Eigen::all) += bread.columns[k][i].transpose() * g;
      of_frame[i] += g.bottomRows(own);
    }
    reduced -= bread.frames[i].gain.transpose() * of_frame[i];
  }
  const Eigen::MatrixXd shared = -inverse * reduced;
  std::vector<SolutionMove> moves;
  for (Eigen::Index p = 0; p < count; ++p) {
    moves.push_back({shared.col(p), std::vector<OwnVector>(frames, OwnVector::Zero(own))});
    for (int i = 1; i < frames; ++i)
      moves.back().own[i] = -bread.frames[i].inverse * of_frame[i].col(p);
  }
  return moves;
}

// The errors r of the points change by q = e + J x, where x is the displacement of the solution by
// the moves, and the best multiple is -q^T W r / q^T W q. Its scores are summed over tracks.
std::optional<Multiple> multiple_of(const SolvedPlanes& solved,
                                    RotationModel model,
                                    const std::vector<Eigen::Matrix2Xd>& moves_px) {
  const auto linearized = linearize(solved, model);
  if (!linearized) return std::nullopt;
  const Bread bread = bread_of(solved, *linearized, model);
  const auto inverse = inverse_information(bread.information);
  if (!inverse) return std::nullopt;
  const Sandwich sandwich{solved, bread, *inverse};
  const SolutionMove move = moves_by_lens(sandwich, {&moves_px, 1})[0];
  std::vector<double> gradients(moves_px.front().cols()), curvatures(moves_px.front().cols());
  for (int i = 1; i < solved.frame_count(); ++i) {
    const OwnVector own = move.own[i] - bread.frames[i].gain * move.shared;
    for (int k = 0; k < std::ssize(bread.columns); ++k) {
      const FrameObservations& f = solved.observations.plane(k)[i];
      const FrameState state = frame_state(solved.observations, solved.motion, i, k);
      Eigen::Matrix<double, 8, 1> local = bread.columns[k][i] * move.shared(bread.places(k));
      local.tail(own.size()) += own;
      const Eigen::VectorXd e = lens_errors_px({&moves_px, 1}, f, state, i);
      for (int o = 0; o < f.count; ++o) {
        const Transfer transfer = transfer_of(f, state, o);
        const Eigen::Vector2d r = transfer.pixel - Eigen::Vector2d(f.u[o], f.v[o]);
        const Eigen::Vector2d q =
            e.segment<2>(Eigen::Index{2} * o) + transfer.jacobian(state.tangents) * local;
        gradients[f.track[o]] += q.dot(weight_of(f, o) * r);
        curvatures[f.track[o]] += q.dot(curvature_of(f, o, r) * q);
      }
    }
  }
  const double curvature = std::accumulate(curvatures.begin(), curvatures.end(), 0.0);
  if (!(curvature > 0)) return std::nullopt;
  const double value = -std::accumulate(gradients.begin(), gradients.end(), 0.0) / curvature;
  double squares = 0;
  for (std::size_t j = 0; j < gradients.size(); ++j)
    squares += std::pow(gradients[j] + value * curvatures[j], 2);
  const double sigma_px = linearized->sigma_px;
  return Multiple{
      value, std::sqrt(squares) / curvature, value * value * curvature / (sigma_px * sigma_px)};
}

Eigen::MatrixXd moves_of_results(const Sandwich& sandwich, std::span<const SolutionMove> moves) {
  const PlaneMotion& motion = sandwich.solved.motion;
  return moves_of_results(motion, results_by_shared(motion, sandwich.bread), moves).results;
}

Eigen::MatrixXd joint_covariance(const Sandwich& sandwich,
                                 const Influences& influences,
                                 double degrees_of_freedom,
                                 std::span<const SolutionMove> of_image,
                                 const SharedMatrix& shared) {
  const PlaneMotion& motion = sandwich.solved.motion;
  const Bread& bread = sandwich.bread;
  const Eigen::MatrixXd M = results_by_shared(motion, bread);
  std::vector<SolutionMove> moves = moves_by_gyro_noise(sandwich);
  moves.insert(moves.end(), of_image.begin(), of_image.end());
  const auto [of_others, others] = moves_of_results(motion, M, moves);
  const auto [of_tracks, tracks] = moves_by_track(sandwich, M, influences, degrees_of_freedom);
  std::vector<int> blocks(bread.frames.size() - 1, 3);
  if (bread.layout.gyro > 0) blocks.push_back(3);
  if (bread.layout.gyro > 3) blocks.push_back(1);
  bread.layout.add_plane_sizes(blocks);
  const Eigen::MatrixXd square = square_of(of_tracks);
  const SharedMatrix rest = shared - tracks * tracks.transpose() - others * others.transpose();
  // A decrease by errors that frames share would exceed what few tracks have in its direction.
  const Eigen::MatrixXd shrunk =
      shrunk_covariance(
          of_tracks, square, covariance_by_observation(motion, M, influences, degrees_of_freedom)) +
      M * power_of_positive(rest, 1) * M.transpose();
  return with_blocks_of(square + M * rest * M.transpose(), blocks, shrunk) + square_of(of_others);
}

NoiseSpread noise_spread(const PlaneMotion& motion,
                         const Eigen::MatrixXd& covariance,
                         const Uncertainty& u) {
  const auto tangents = normal_tangents(motion.normal);
  const Eigen::Index planes_at = covariance.rows() - 3 * std::ssize(u.others) - 2;
  NoiseSpread spread{covariance.block<2, 2>(planes_at, planes_at), {Eigen::Matrix3d::Zero()}, {0}};
  for (std::size_t i = 1; i < motion.tau.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * (i - 1));
    spread.centers.emplace_back(covariance.block<3, 3>(at, at));
    Eigen::VectorXd ratio = Eigen::VectorXd::Zero(covariance.rows());
    ratio.segment<3>(at) = motion.normal;
    ratio.segment<2>(planes_at) = -(tangents.transpose() * motion.tau[i]);
    spread.distance_ratios.push_back(ratio.dot(covariance * ratio));
  }
  return spread;
}

void add_to_marginals(const PlaneMotion& motion, const Eigen::MatrixXd& change, Uncertainty& u) {
  const auto add = [](double variance, double& sigma) {
    sigma = std::sqrt(std::max(0.0, sigma * sigma + variance));
  };
  const NoiseSpread spread = noise_spread(motion, change, u);
  for (std::size_t i = 1; i < motion.tau.size(); ++i) {
    u.center_covariances[i] += spread.centers[i];
    add(spread.distance_ratios[i], u.distance_ratio_sigmas[i]);
  }
  const Eigen::Index gyro_at = 3 * (std::ssize(motion.tau) - 1);
  const Eigen::Index planes_at = change.rows() - 3 * std::ssize(u.others) - 2;
  const Eigen::Index gyro = planes_at - gyro_at;
  if (u.bias_covariance && gyro > 0) *u.bias_covariance += change.block<3, 3>(gyro_at, gyro_at);
  if (u.time_offset_sigma_s && gyro > 3)
    add(change(gyro_at + 3, gyro_at + 3), *u.time_offset_sigma_s);
  for (std::size_t k = 0; k < u.others.size(); ++k) {
    const Eigen::Index at = planes_at + UnknownsLayout::of_plane(static_cast<int>(k) + 1) + 2;
    add(change(at, at), u.others[k].log_distance_sigma);
  }
}

}  // namespace gpo
