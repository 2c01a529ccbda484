// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/neighbors.h"

#include "engine/methods/certainty/shared_information.h"

#include <algorithm>
#include <array>
#include <map>
#include <span>

namespace gpo {
namespace {

using Eigen::Vector2d;

constexpr int kBlocks = 16;
constexpr int kLeastPlaces = 3 * kBlocks;

constexpr int kQuarters = 4;
/// Degrees of freedom of the spreads, mostly along one direction; their mean stands out where it is
/// so many times what independent tracks would make it, which chance exceeds in one window of ten.
constexpr double kFreedomOfQuarters = kQuarters - 1;
constexpr double kFreedomOfBlocks = kBlocks - 1;
constexpr double kLeastDisagreement = 1.45;

struct PlacedTrack {
  int track = 0;
  Vector2d ray;
};

/// Halves the tracks in turn by x and y; sixteenths of a quarter are neighbors in number.
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

/// The sixteenth of each of the window's tracks; empty where the tracks are too few.
std::vector<int> blocks_of(const PlaneObservations& observations, int tracks) {
  std::map<int, Vector2d> places;
  for (int k = 0; k <= static_cast<int>(observations.others.size()); ++k)
    for (const FrameObservations& f : of_plane(observations, k))
      for (int o = 0; o < f.count; ++o) places[f.track[o]] = {f.ray_x[o], f.ray_y[o]};
  if (static_cast<int>(places.size()) < kLeastPlaces) return {};
  std::vector<PlacedTrack> placed;
  placed.reserve(places.size());
  for (const auto& [track, ray] : places) placed.push_back({track, ray});
  std::vector<int> blocks(tracks, 0);
  divide(placed, 0, kBlocks, 0, blocks);
  return blocks;
}

/// A frame's observations by block, each padded as the kernels want it.
std::array<FrameObservations, kBlocks> split(const FrameObservations& f,
                                             const std::vector<int>& blocks) {
  std::array<FrameObservations, kBlocks> parts;
  const auto add = [&](FrameObservations& part, int o, double mask) {
    part.ray_x.push_back(f.ray_x[o]);
    part.ray_y.push_back(f.ray_y[o]);
    part.u.push_back(f.u[o]);
    part.v.push_back(f.v[o]);
    part.mask.push_back(mask);
  };
  for (int o = 0; o < f.count; ++o) {
    FrameObservations& part = parts[blocks[f.track[o]]];
    add(part, o, f.mask[o]);
    part.track.push_back(f.track[o]);
    if (!f.weight.empty()) part.weight.push_back(f.weight[o]);
    ++part.count;
  }
  for (FrameObservations& part : parts) {
    if (part.count == 0) continue;
    const int first = static_cast<int>(std::ranges::find(f.track, part.track[0]) - f.track.begin());
    while (part.mask.size() % kKernelWidth != 0) add(part, first, 0);
  }
  return parts;
}

void add(const FrameNormals& one, double sign, FrameNormals& to) {
  to.JtJ += sign * one.JtJ;
  to.Jtr += sign * one.Jtr;
}

std::vector<Linearization> linearize_blocks(const PlaneObservations& observations,
                                            const PlaneMotion& motion,
                                            const std::vector<int>& blocks,
                                            double sigma_px) {
  const int planes = 1 + static_cast<int>(observations.others.size());
  const int frames = static_cast<int>(motion.tau.size());
  const std::vector<std::vector<FrameNormals>> none(planes, std::vector<FrameNormals>(frames));
  std::vector<Linearization> all(kBlocks, {none, sigma_px});
  for (int k = 0; k < planes; ++k) {
    for (int i = 1; i < frames; ++i) {
      const FrameState state = state_of(observations, motion, i, k);
      const auto parts = split(of_plane(observations, k)[i], blocks);
      for (int b = 0; b < kBlocks; ++b)
        if (parts[b].count > 0) all[b].planes[k][i] = curved_normals(parts[b], state);
    }
  }
  return all;
}

void add(const Linearization& one, double sign, Linearization& to) {
  for (std::size_t k = 0; k < one.planes.size(); ++k)
    for (std::size_t i = 1; i < one.planes[k].size(); ++i)
      add(one.planes[k][i], sign, to.planes[k][i]);
}

/// The step of what the frames share that a part's errors ask for, where `bread` is of another
/// part.
Eigen::VectorXd step_of(const Linearization& part,
                        const Bread& bread,
                        const SharedMatrix& inverse) {
  Eigen::VectorXd reduced = Eigen::VectorXd::Zero(bread.layout.size());
  for (std::size_t i = 1; i < bread.frames.size(); ++i) {
    Eigen::Matrix<double, 8, 1> both = Eigen::Matrix<double, 8, 1>::Zero();
    for (std::size_t k = 0; k < part.planes.size(); ++k) {
      const auto& g = part.planes[k][i].Jtr;
      reduced(bread.places(static_cast<int>(k))) += bread.columns[k][i].transpose() * g;
      both += g;
    }
    reduced -= bread.frames[i].gain.transpose() * both.tail(bread.frames[i].inverse.rows());
  }
  return -(inverse * reduced);
}

/// Whether the observations ask for no step of the normal that matters: elsewhere than at the
/// solution, say where a gyroscope's wrong bias was held, every block asks for one.
bool is_solution(const Linearization& whole,
                 const PlaneMotion& motion,
                 const Bread& bread,
                 const SharedMatrix& inverse,
                 const SharedMatrix& noise) {
  Eigen::VectorXd step = step_of(whole, bread, inverse);
  for (std::size_t i = 1; i < bread.noise_weights.size(); ++i) {  // where its prior pulls
    const Eigen::Vector3d g = bread.noise_weights[i] * motion.gyro_noise_rad[i];
    const Eigen::VectorXd pull = bread.frames[i].gain.topRows<3>().transpose() * g;
    step += inverse * pull;
  }
  return step.head<2>().squaredNorm() < 0.25 * noise.topLeftCorner<2, 2>().trace();
}

/// How far what the frames share moves as blocks are left out, and how far independent errors of
/// one size would move it: the covariance of the difference is the difference of the covariances.
struct Moved {
  SharedMatrix spread;
  SharedMatrix expected;
};

std::optional<Moved> leave_out(const Window& window,
                               const PlaneMotion& motion,
                               RotationModel model,
                               const std::vector<Linearization>& blocks,
                               const Linearization& whole,
                               const SharedMatrix& of_all,
                               int of) {
  const double scale = (of - 1.0) / of;
  const double sigma2 = whole.sigma_px * whole.sigma_px;
  const SharedMatrix none = SharedMatrix::Zero(of_all.rows(), of_all.cols());
  Moved moved{none, none};
  const int step = kBlocks / of;
  for (int b = 0; b < kBlocks; b += step) {
    Linearization left = whole;
    Linearization out = blocks[b];
    for (int k = 1; k < step; ++k) add(blocks[b + k], 1, out);
    add(out, -1, left);
    const Bread bread = bread_of(window, motion, left, model);
    const auto inverse = inverse_information(bread.information);
    if (!inverse) return std::nullopt;
    // The errors of all ask for no step, so the others' step is minus the block's.
    const Eigen::VectorXd x = -step_of(out, bread, *inverse);
    moved.spread += scale * x * x.transpose();
    moved.expected += scale * sigma2 * (*inverse - of_all);
  }
  return moved;
}

}  // namespace

std::vector<std::optional<Eigen::Matrix2d>> neighbors_spread(const Window& window,
                                                             const PlaneObservations& observations,
                                                             const PlaneMotion& motion,
                                                             RotationModel model,
                                                             double sigma_px,
                                                             const SharedMatrix& noise) {
  const int planes = 1 + static_cast<int>(observations.others.size());
  std::vector<std::optional<Eigen::Matrix2d>> spreads(planes);
  const std::vector<int> block_of_track = blocks_of(observations, window.track_count());
  if (block_of_track.empty() || !(sigma_px > 0)) return spreads;
  const auto blocks = linearize_blocks(observations, motion, block_of_track, sigma_px);
  Linearization whole = blocks[0];
  for (int b = 1; b < kBlocks; ++b) add(blocks[b], 1, whole);
  const Bread bread = bread_of(window, motion, whole, model);
  const auto independent = inverse_information(bread.information);
  if (!independent || !is_solution(whole, motion, bread, *independent, noise)) return spreads;
  const auto quarters = leave_out(window, motion, model, blocks, whole, *independent, kQuarters);
  const auto sixteenths = leave_out(window, motion, model, blocks, whole, *independent, kBlocks);
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
      spreads[k] = quarters->spread.block<2, 2>(at, at);
    else if (mean > 1)
      spreads[k] = mean * of_noise;
  }
  return spreads;
}

}  // namespace gpo
