// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/sandwich.h"

#include "engine/geometry/decompositions.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/plane/plane_weights.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

namespace gpo {
namespace {

using Eigen::Vector3d;

constexpr int kLeastClusters = 5;  // least number of frames as clusters

int gyro_size(RotationModel model) { return model == RotationModel::bias ? 3 : 0; }

/// Displacement of the solution by one observation.
struct Influence {
  int frame = 0;
  int track = 0;
  Eigen::VectorXd shared;
  OwnVector own;
};

/// Returns the influences of all observations, frame by frame.
std::vector<Influence> influences(const Sandwich& sandwich) {
  const auto& [solved, bread, inverse] = sandwich;
  std::vector<Influence> all;
  all.reserve(solved.observations.count());
  for (int i = 1; i < solved.frame_count(); ++i) {
    const Eliminated& frame = bread.frames[i];
    const auto own = frame.inverse.rows();
    for (int k = 0; k < std::ssize(bread.columns); ++k) {
      const FrameObservations& f = solved.observations.plane(k)[i];
      const FrameState state = frame_state(solved.observations, solved.motion, i, k);
      const std::vector<int> at = bread.places(k);
      for (int o = 0; o < f.count; ++o) {
        const Eigen::Matrix<double, 8, 1> g =
            gradient_of(f, state, o, transfer_error_px(f, state, o));
        Eigen::VectorXd reduced = -(frame.gain.transpose() * g.tail(own));
        reduced(at) += bread.columns[k][i].transpose() * g;
        all.push_back({i, f.track[o], -(inverse * reduced), -(frame.inverse * g.tail(own))});
      }
    }
  }
  return all;
}

/// Returns the part of the spread that frames have in common, without that of single observations;
/// zero with too few frames.
SharedMatrix spread_by_frame(const std::vector<Influence>& all,
                             int size,
                             int frames,
                             double degrees_of_freedom) {
  SharedMatrix spread = SharedMatrix::Zero(size, size);
  if (frames - 1 < kLeastClusters) return spread;
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(size, frames);
  for (const Influence& one : all) {
    sums.col(one.frame) += one.shared;
    spread -= one.shared * one.shared.transpose();
  }
  spread += (frames - 1.0) / (frames - 2.0) * sums * sums.transpose();
  return degrees_of_freedom * spread;
}

}  // namespace

std::optional<FrameObservations> curvature_weights(const FrameObservations& f,
                                                   const FrameState& state) {
  if (!f.weight.empty()) return std::nullopt;
  if (std::all_of(f.mask.begin(), f.mask.begin() + f.count, [](double m) { return m == 1; }))
    return std::nullopt;
  FrameObservations curved = f;
  curved.weight.assign(f.count, Eigen::Matrix2d::Identity());
  for (int k = 0; k < f.count; ++k) {
    if (f.mask[k] == 1) continue;
    const Eigen::Vector2d r = transfer_error_px(f, state, k).normalized();
    curved.weight[k] = f.mask[k] * f.mask[k] * (Eigen::Matrix2d::Identity() - r * r.transpose());
  }
  return curved;
}

Eigen::Matrix<double, 8, 1> gradient_of(const FrameObservations& f,
                                        const FrameState& state,
                                        int k,
                                        const Eigen::Vector2d& r) {
  const Eigen::Matrix<double, 2, 8> J = transfer_of(f, state, k).jacobian(state.tangents);
  return f.weight.empty() ? (f.mask[k] * f.mask[k] * (J.transpose() * r)).eval()
                          : (J.transpose() * (f.weight[k] * r)).eval();
}

int own_size(RotationModel model, const PlaneMotion& motion) {
  const bool noisy = model == RotationModel::bias && !motion.gyro_noise_rad.empty();
  return model == RotationModel::free || noisy ? 6 : 3;
}

FrameNormals curved_normals(const FrameObservations& f, const FrameState& state) {
  FrameNormals normals = weighted_normals(f, state, Rotating::yes);
  if (const auto of_loss = curvature_weights(f, state))
    normals.JtJ = weighted_normals(*of_loss, state, Rotating::yes).JtJ;
  return normals;
}

std::optional<Linearization> linearize(const SolvedPlanes& solved, RotationModel model) {
  const PlaneObservations& observations = solved.observations;
  const int frames = solved.frame_count();
  Linearization all;
  all.planes.assign(observations.plane_count(), std::vector<FrameNormals>(frames));
  double cost = 0;
  bool huber = false;
  for (int k = 0; k < observations.plane_count(); ++k) {
    for (int i = 1; i < frames; ++i) {
      const FrameObservations& f = observations.plane(k)[i];
      const FrameState state = frame_state(observations, solved.motion, i, k);
      FrameNormals& normals = all.planes[k][i] = curved_normals(f, state);
      huber = huber || curvature_weights(f, state);
      if (!normals.in_front) return std::nullopt;
      cost += normals.cost;
    }
  }
  const UnknownsLayout layout{observations.plane_count() - 1, gyro_size(model)};
  const int unknowns = layout.size() + own_size(model, solved.motion) * (frames - 1);
  all.sigma_px = noise_px(2 * cost, 2 * observations.count(), unknowns);
  if (huber) all.sigma_px /= kSigmaOfHuber;
  return all;
}

std::vector<int> Bread::places(int plane) const {
  std::vector<int> places(UnknownsLayout::size_of_plane(plane) + layout.gyro);
  const auto gyro = places.end() - layout.gyro;
  std::iota(places.begin(), gyro, UnknownsLayout::of_plane(plane));
  std::iota(gyro, places.end(), layout.of_gyro());
  return places;
}

Bread bread_of(const SolvedPlanes& solved, const Linearization& linearized, RotationModel model) {
  const auto& [window, observations, motion] = solved;
  const int planes = static_cast<int>(linearized.planes.size());
  const int frames = solved.frame_count();
  const int own = own_size(model, motion);
  Bread bread{.layout = {planes - 1, gyro_size(model)}};
  const int size = bread.layout.size();
  bread.columns.assign(planes, std::vector<PlaneColumns>(frames));
  bread.frames.resize(frames);
  bread.prior = SharedMatrix::Zero(size, size);
  if (bread.layout.gyro > 0)
    bread.prior.diagonal().tail<3>().setConstant(
        prior_weight(linearized.sigma_px, window.gyro->prior_sigma_rad_s));
  bread.information = bread.prior;
  if (model == RotationModel::bias && own == 6) bread.noise_weights.resize(frames);
  for (int i = 1; i < frames; ++i) {
    const GyroColumns gyro = gyro_columns(window, motion, i, bread.layout.gyro);
    const Vector3d tau_c = motion.R_wc[i].transpose() * motion.tau[i];
    SharedMatrix so = SharedMatrix::Zero(size, own);
    OwnMatrix oo = OwnMatrix::Zero(own, own);
    for (int k = 0; k < planes; ++k) {
      const auto& F = linearized.planes[k][i].JtJ;
      const PlaneColumns& M = bread.columns[k][i] = plane_columns(k, tau_c, gyro);
      const std::vector<int> at = bread.places(k);
      bread.information(at, at) += M.transpose() * F * M;
      so(at, Eigen::all) += M.transpose() * F.rightCols(own);
      oo += F.bottomRightCorner(own, own);
    }
    if (!bread.noise_weights.empty()) {
      bread.noise_weights[i] = prior_weight(linearized.sigma_px, gyro_noise_sigma_rad(window, i));
      oo.diagonal().head<3>().array() += bread.noise_weights[i];
    }
    const OwnMatrix inverse = inverse_of_symmetric(oo);
    bread.information -= so * inverse * so.transpose();
    bread.frames[i] = {inverse, inverse * so.transpose()};
  }
  return bread;
}

Eigen::VectorXd newton_step(const Sandwich& sandwich, const Linearization& linearized) {
  const Bread& bread = sandwich.bread;
  Eigen::VectorXd reduced = Eigen::VectorXd::Zero(bread.layout.size());
  for (int i = 1; i < std::ssize(bread.frames); ++i) {
    const auto& gain = bread.frames[i].gain;
    for (int k = 0; k < std::ssize(bread.columns); ++k) {
      const auto& g = linearized.planes[k][i].Jtr;
      reduced(bread.places(k)) += bread.columns[k][i].transpose() * g;
      reduced -= gain.transpose() * g.tail(gain.rows());
    }
  }
  return -(sandwich.inverse * reduced);
}

void Spread::add(const SolutionMove& move) {
  const auto& [x, e] = move;
  shared += x * x.transpose();
  for (std::size_t i = 1; i < e.size(); ++i) {
    cross[i] += x * e[i].transpose();
    own[i] += e[i] * e[i].transpose();
  }
}

Spread spread_of(const Sandwich& sandwich, double degrees_of_freedom) {
  const int frames = sandwich.solved.frame_count();
  const int size = sandwich.bread.layout.size();
  const auto own = sandwich.bread.frames[1].inverse.rows();
  const std::vector<Influence> all = influences(sandwich);
  const int columns = sandwich.solved.window.track_count();
  Eigen::MatrixXd of_track = Eigen::MatrixXd::Zero(size, columns);
  std::vector<char> seen(columns, 0);
  for (const Influence& one : all) {
    of_track.col(one.track) += one.shared;
    seen[one.track] = 1;
  }
  const auto tracks = static_cast<double>(std::ranges::count(seen, 1));
  const double of_tracks = degrees_of_freedom * tracks / std::max(1.0, tracks - 1);
  Spread spread{of_tracks * of_track * of_track.transpose(),
                std::vector<SharedMatrix>(frames, SharedMatrix::Zero(size, own)),
                std::vector<OwnMatrix>(frames, OwnMatrix::Zero(own, own))};
  for (const Influence& one : all) {
    spread.cross[one.frame] += of_tracks * of_track.col(one.track) * one.own.transpose();
    spread.own[one.frame] += of_tracks * one.own * one.own.transpose();
  }
  // The frames' part may only increase the spread: a decrease is noise of few frames.
  const SharedMatrix both = spread.shared + spread_by_frame(all, size, frames, degrees_of_freedom);
  const auto of_normal = [](const SharedMatrix& x) { return x.topLeftCorner<2, 2>().trace(); };
  if (of_normal(both) > of_normal(spread.shared) && symmetric_eigen(both).values(0) >= 0)
    spread.shared = both;
  return spread;
}

std::vector<SolutionMove> moves_by_track(const Sandwich& sandwich, double degrees_of_freedom) {
  const std::vector<Influence> all = influences(sandwich);
  std::vector<int> place(sandwich.solved.window.track_count(), -1);
  int tracks = 0;
  for (const Influence& one : all)
    if (place[one.track] < 0) place[one.track] = tracks++;
  const OwnVector none = OwnVector::Zero(sandwich.bread.frames[1].inverse.rows());
  std::vector<SolutionMove> moves(tracks,
                                  {Eigen::VectorXd::Zero(sandwich.bread.layout.size()),
                                   {sandwich.solved.motion.tau.size(), none}});
  const double weight =
      std::sqrt(degrees_of_freedom * tracks / std::max(1.0, static_cast<double>(tracks) - 1));
  for (const Influence& one : all) {
    SolutionMove& move = moves[place[one.track]];
    move.shared += weight * one.shared;
    move.own[one.frame] += weight * one.own;
  }
  return moves;
}

}  // namespace gpo
