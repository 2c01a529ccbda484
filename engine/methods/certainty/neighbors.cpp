// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/neighbors.h"

#include "engine/methods/certainty/shared_information.h"
#include "engine/methods/plane/plane_weights.h"

#include <algorithm>
#include <map>
#include <span>

namespace gpo {
namespace {

using Eigen::Vector2d;

constexpr int kBlocks = 16;
constexpr int kLeastPlaces = 3 * kBlocks;

constexpr int kQuarters = 4;
/// Degrees of freedom of the spreads, mostly along one direction.
constexpr double kFreedomOfQuarters = kQuarters - 1;
constexpr double kFreedomOfBlocks = kBlocks - 1;
/// Significant ratio of their mean to that of independent tracks, exceeded by chance in one window
/// of ten.
constexpr double kLeastDisagreement = 1.45;

struct PlacedTrack {
  int track = 0;
  Vector2d ray;
};

/// Divides the tracks into equal blocks, alternately by x and y; the four blocks of a quarter have
/// consecutive numbers.
void divide(std::span<PlacedTrack> tracks, int first, int blocks, int axis, std::vector<int>& of) {
  if (blocks == 1) {
    for (const PlacedTrack& one : tracks) of[one.track] = first;
    return;
  }
  const auto middle = tracks.begin() + static_cast<std::ptrdiff_t>(tracks.size() / 2);
  std::ranges::nth_element(tracks, middle, {}, [&](const PlacedTrack& t) { return t.ray(axis); });
  divide({tracks.begin(), middle}, first, blocks / 2, 1 - axis, of);
  divide({middle, tracks.end()}, first + blocks / 2, blocks / 2, 1 - axis, of);
}

/// Returns the block of each of the window's tracks; empty with too few tracks.
std::vector<int> blocks_of(const PlaneObservations& observations, int tracks) {
  std::map<int, Vector2d> places;
  for (int k = 0; k < observations.plane_count(); ++k)
    for (const FrameObservations& f : observations.plane(k))
      for (int o = 0; o < f.count; ++o) places[f.track[o]] = {f.ray_x[o], f.ray_y[o]};
  if (static_cast<int>(places.size()) < kLeastPlaces) return {};
  std::vector<PlacedTrack> placed;
  placed.reserve(places.size());
  for (const auto& [track, ray] : places) placed.push_back({track, ray});
  std::vector<int> blocks(tracks, 0);
  divide(placed, 0, kBlocks, 0, blocks);
  return blocks;
}

std::vector<Linearization> linearize_blocks(const SolvedPlanes& solved,
                                            const std::vector<int>& blocks,
                                            double sigma_px) {
  const auto& [window, observations, motion] = solved;
  const int planes = observations.plane_count();
  const int frames = solved.frame_count();
  const std::vector<std::vector<FrameNormals>> none(planes, std::vector<FrameNormals>(frames));
  std::vector<Linearization> all(kBlocks, {none, sigma_px});
  for (int k = 0; k < planes; ++k) {
    for (int i = 1; i < frames; ++i) {
      const FrameState state = frame_state(observations, motion, i, k);
      const FrameObservations& f = observations.plane(k)[i];
      for (int o = 0; o < f.count; ++o)
        add_curved(f, state, o, all[blocks[f.track[o]]].planes[k][i]);
    }
  }
  return all;
}

void add(const Linearization& one, double sign, Linearization& to) {
  for (std::size_t k = 0; k < one.planes.size(); ++k) {
    for (std::size_t i = 1; i < one.planes[k].size(); ++i) {
      to.planes[k][i].JtJ += sign * one.planes[k][i].JtJ;
      to.planes[k][i].Jtr += sign * one.planes[k][i].Jtr;
    }
  }
}

/// Returns true if the step of the normal is negligible. Away from the minimum, e.g. with a wrong
/// gyroscope bias held, every block has a step.
bool is_solution(const Linearization& whole,
                 const PlaneMotion& motion,
                 const Bread& bread,
                 const SharedMatrix& inverse,
                 const SharedMatrix& noise) {
  Eigen::VectorXd step = -(inverse * reduced_gradient(whole, bread));
  for (std::size_t i = 1; i < bread.noise_weights.size(); ++i) {  // step by the noise prior
    const Eigen::Vector3d g = bread.noise_weights[i] * motion.gyro_noise_rad[i];
    const Eigen::VectorXd pull = bread.frames[i].gain.topRows<3>().transpose() * g;
    step += inverse * pull;
  }
  return step.head<2>().squaredNorm() < 0.25 * noise.topLeftCorner<2, 2>().trace();
}

/// Spread of the shared unknowns if blocks are left out, and its expectation for independent
/// errors: the covariance of the difference is the difference of the covariances.
struct Moved {
  SharedMatrix spread;
  SharedMatrix expected;
};

/// The blocks' linearizations, and their sum with its bread.
struct Jackknife {
  std::vector<Linearization> blocks;
  Linearization whole;
  Bread bread = {};
};

/// Leaves out each of `parts` regions in turn; `of_all` is the covariance without noise scale.
/// nullopt if the rest does not determine the unknowns.
std::optional<Moved> leave_out(const Jackknife& jackknife, const SharedMatrix& of_all, int parts) {
  const auto& [blocks, whole, of_whole] = jackknife;
  const double scale = (parts - 1.0) / parts;
  const double sigma2 = whole.sigma_px * whole.sigma_px;
  const SharedMatrix none = SharedMatrix::Zero(of_all.rows(), of_all.cols());
  Moved moved{none, none};
  const int step = kBlocks / parts;
  Bread bread = of_whole;
  for (int b = 0; b < kBlocks; b += step) {
    Linearization left = whole;
    Linearization out = blocks[b];
    for (int k = 1; k < step; ++k) add(blocks[b + k], 1, out);
    add(out, -1, left);
    eliminate(left, bread);
    const auto inverse = inverse_information(bread.information);
    if (!inverse) return std::nullopt;
    // The sum over all blocks has no step: the step of the others is minus that of the block.
    const Eigen::VectorXd x = *inverse * reduced_gradient(out, bread);
    moved.spread += scale * x * x.transpose();
    moved.expected += scale * sigma2 * (*inverse - of_all);
  }
  return moved;
}

}  // namespace

std::vector<std::optional<Eigen::Matrix2d>> neighbors_spread(const SolvedPlanes& solved,
                                                             RotationModel model,
                                                             double sigma_px,
                                                             const SharedMatrix& noise) {
  const int planes = solved.observations.plane_count();
  std::vector<std::optional<Eigen::Matrix2d>> spreads(planes);
  const auto block_of_track = blocks_of(solved.observations, solved.window.track_count());
  if (block_of_track.empty() || !(sigma_px > 0)) return spreads;
  Jackknife jackknife{linearize_blocks(solved, block_of_track, sigma_px), {}};
  jackknife.whole = jackknife.blocks[0];
  for (int b = 1; b < kBlocks; ++b) add(jackknife.blocks[b], 1, jackknife.whole);
  const Bread& bread = jackknife.bread = bread_of(solved, jackknife.whole, model);
  const auto independent = inverse_information(bread.information);
  if (!independent || !is_solution(jackknife.whole, solved.motion, bread, *independent, noise))
    return spreads;
  const auto quarters = leave_out(jackknife, *independent, kQuarters);
  const auto sixteenths = leave_out(jackknife, *independent, kBlocks);
  if (!quarters || !sixteenths) return spreads;
  for (int k = 0; k < planes; ++k) {
    const int at = UnknownsLayout::of_plane(k);
    const auto trace = [&](const SharedMatrix& m) { return m.block<2, 2>(at, at).trace(); };
    const double over_independent = trace(noise) / (sigma_px * sigma_px * trace(*independent));
    const auto excess = [&](const Moved& moved) {
      return trace(moved.spread) / (over_independent * trace(moved.expected));
    };
    const double mean =
        (kFreedomOfQuarters * excess(*quarters) + kFreedomOfBlocks * excess(*sixteenths)) /
        (kFreedomOfQuarters + kFreedomOfBlocks);
    const Eigen::Matrix2d of_noise = noise.block<2, 2>(at, at);
    if (mean > kLeastDisagreement && trace(quarters->spread) > mean * trace(noise))
      spreads[k] = quarters->spread.block<2, 2>(at, at) - of_noise;
    else if (mean > 1)
      spreads[k] = (mean - 1) * of_noise;
  }
  return spreads;
}

}  // namespace gpo
