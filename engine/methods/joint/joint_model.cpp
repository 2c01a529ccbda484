// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/joint/joint_model.h"

#include "engine/methods/plane/plane_weights.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace gpo::joint {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

Monomials monomials(const Vector2d& p) {
  const double x = p.x(), y = p.y();
  Monomials all;
  all << x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
  return all;
}

/// The frame's state when it reads the rows that are `seconds` after its time stamp.
FrameState state_after(FrameState state, const Velocity& velocity, double seconds) {
  if (seconds == 0) return state;
  const Matrix3d turn = so3_exp(-velocity.rotation_rad(seconds));
  state.tau_c = turn * (state.tau_c + state.R_cw * velocity.tau(seconds));
  state.R_cw = turn * state.R_cw;
  return state;
}

/// Weights of an observation: of its gradient and, as a root, of its second derivatives.
struct Weights {
  double gradient = 0;
  Matrix2d root = Matrix2d::Zero();
  double cost = 0;
};

/// Noise of an observation, and its weight against typical ones of the other frames.
struct ObservationNoise {
  double sigma_px = 1;
  double scale = 1;
  bool gated = true;
};

Weights weights_of(const Vector2d& r,
                   const ObservationNoise& noise,
                   bool huber,
                   Curvature curvature) {
  const auto& [sigma_px, scale, gated] = noise;
  const double length = r.norm();
  const double knee = kHuberSigmas * sigma_px;
  if (!huber || length <= knee)
    return {scale, std::sqrt(scale) * Matrix2d::Identity(), 0.5 * scale * length * length};
  const double gate = kGateSigmas * sigma_px;
  const double cost = scale * knee * ((gated ? std::min(length, gate) : length) - 0.5 * knee);
  if (gated && length > gate) return {.cost = cost};
  const double weight = scale * knee / length;
  Matrix2d root = std::sqrt(weight) * Matrix2d::Identity();
  // Beyond the knee the loss has no curvature along the error.
  if (curvature == Curvature::of_loss)
    root -= std::sqrt(weight) / (length * length) * r * r.transpose();
  return {weight, root, cost};
}

}  // namespace

Model::Model(const Window& window,
             const PlaneObservations& observations,
             const PlaneMotion& start,
             const Options& options)
    : window_(window),
      lens_moves_px_(window.lens_moves_px.empty() ? typical_lens_moves_px(window)
                                                  : window.lens_moves_px),
      observations_(observations),
      options_(options),
      image_px_(std::hypot(window.K(0, 2), window.K(1, 2))) {
  layout_.shared = {static_cast<int>(observations.others.size()),
                    options.rotations != RotationModel::bias ? 0
                    : options.time_offset                    ? 4
                                                             : 3};
  layout_.row_delay = options.row_delay && options.row_delay->sigma_s > 0 ? 1 : 0;
  layout_.lens_parameters = static_cast<int>(lens_moves_px_.size());
  layout_.typical_lens = window.lens_moves_px.empty();
  layout_.planes = observations.plane_count();
  layout_.own = options.rotations == RotationModel::free || options.gyro_noise ? 6 : 3;
  layout_.frames = window.frame_count();
  layout_.velocity = options.free_velocities ? 6 : 0;
  gather_tracks();
  if (options.gyro_noise) walk_ = walk_information(start);
}

void Model::gather_tracks() {
  for (int k = 0; k < layout_.planes; ++k) {
    std::vector<int> place(window_.track_count(), -1);
    for (int i = 1; i < layout_.frames; ++i) {
      const FrameObservations& f = observations_.plane(k)[i];
      for (int o = 0; o < f.count; ++o) {
        int& at = place[f.track[o]];
        if (at < 0) {
          at = static_cast<int>(tracks_.size());
          const Vector2d reference_px(f.ray_x[o] * observations_.fx, f.ray_y[o] * observations_.fy);
          tracks_.push_back({.plane = k, .column = f.track[o], .reference_px = reference_px});
        }
        tracks_[at].seen.push_back({i, o});
      }
    }
  }
}

State Model::first(const PlaneMotion& start) const {
  State state{.motion = start,
              .row_delay_s = options_.row_delay ? options_.row_delay->mean_s : 0,
              .lens = VectorXd::Zero(kLensTerms),
              .shift_px = Eigen::Matrix2Xd::Zero(2, std::ssize(tracks_)),
              .velocities = {}};
  if (options_.gyro_noise && state.motion.gyro_noise_rad.empty())
    state.motion.gyro_noise_rad.assign(layout_.frames, Vector3d::Zero());
  update_velocities(state, {});
  return state;
}

PathNoise Model::path_noise(const Normals& at, const Scales& scales) const {
  double rotation = 0, tau = 0;
  for (int i = 1; i < layout_.frames; ++i) {
    const Index own = layout_.at_frame(i);
    const MatrixXd inverse = at.A.block(own, own, layout_.own, layout_.own).inverse();
    tau += inverse.bottomRightCorner<3, 3>().trace();
    if (layout_.own == 6) rotation += inverse.topLeftCorner<3, 3>().trace();
  }
  const double axes = 3.0 * (layout_.frames - 1);
  // The gyroscope's own path is smoother than the noise of single images.
  if (options_.rotations == RotationModel::bias) rotation = 0;
  return {scales.sigma_px * std::sqrt(rotation / axes), scales.sigma_px * std::sqrt(tau / axes)};
}

void Model::update_velocities(State& state, const PathNoise& noise) const {
  if (options_.row_delay)
    state.velocities = smooth_velocities(window_.timestamps_ns, state.motion, noise);
  else
    state.velocities.assign(layout_.frames, {});
}

Vector2d Model::observed_px(const Track& track, Track::Seen seen) const {
  if (seen.frame == 0) return track.reference_px;
  const FrameObservations& f = observations_.plane(track.plane)[seen.frame];
  return {f.u[seen.index], f.v[seen.index]};
}

std::vector<int> Model::columns_of(int plane, int frame) const {
  std::vector<int> columns;
  const auto add = [&](int first, int count) {
    for (int c = 0; c < count; ++c) columns.push_back(first + c);
  };
  add(UnknownsLayout::of_plane(plane), UnknownsLayout::size_of_plane(plane));
  add(layout_.shared.of_gyro(), layout_.shared.gyro);
  add(layout_.at_row_delay(), layout_.row_delay);
  add(layout_.at_parameters(), layout_.lens_parameters);
  add(layout_.at_lens(), kLensTerms);
  add(layout_.at_velocity(frame), layout_.velocity);
  if (frame > 0) add(layout_.at_frame(frame), layout_.own);
  return columns;
}

std::vector<std::vector<FrameState>> Model::stamps(const State& state) const {
  std::vector<std::vector<FrameState>> all(layout_.planes);
  for (int k = 0; k < layout_.planes; ++k)
    for (int i = 0; i < layout_.frames; ++i)
      all[k].push_back(frame_state(observations_, state.motion, i, k));
  return all;
}

Model::Prediction Model::predict(const State& state,
                                 const FrameState& at_stamp,
                                 int number,
                                 Track::Seen seen) const {
  const Track& track = tracks_[number];
  Prediction p;
  p.seconds = state.row_delay_s * window_.readout_direction.dot(observed_px(track, seen));
  p.at = state_after(at_stamp, state.velocities[seen.frame], p.seconds);
  const Vector2d latent = track.reference_px + state.shift_px.col(number);
  p.transfer = transfer_on_plane(p.at, Vector3d(latent.x() / p.at.fx, latent.y() / p.at.fy, 1));
  // A point that is nearer by a share of its distance.
  p.d_height = p.transfer.d_translation() * p.transfer.tau_c;
  // At the predicted pixel: the noise of the observed one is correlated with the error.
  p.lens = monomials(p.transfer.pixel / image_px_);
  p.r = p.transfer.pixel - observed_px(track, seen);
  p.r.x() += p.lens.dot(state.lens.head<kMonomials>());
  p.r.y() += p.lens.dot(state.lens.tail<kMonomials>());
  return p;
}

Eigen::Matrix2Xd Model::reference_errors_px(const State& state) const {
  const auto at = stamps(state);
  Eigen::Matrix2Xd errors(2, std::ssize(tracks_));
  for (int j = 0; j < errors.cols(); ++j)
    errors.col(j) = predict(state, at[tracks_[j].plane].front(), j, {}).r;
  return errors;
}

Eigen::Matrix2Xd Model::errors_px(const State& state) const {
  const auto at = stamps(state);
  Eigen::Matrix2Xd errors(2, observation_count());
  Index count = 0;
  for (int j = 0; j < std::ssize(tracks_); ++j)
    for (const Track::Seen& seen : std::span(tracks_[j].seen).subspan(1))
      errors.col(count++) =
          predict(state, at[tracks_[j].plane][seen.frame], j, seen).r / noise_ratio(j, seen.frame);
  return errors.leftCols(count);
}

Model::Row Model::jacobian(const State& state,
                           const Prediction& p,
                           const Track& track,
                           const Shared& shared) const {
  const int frame = shared.frame;
  const Velocity& velocity = state.velocities[frame];
  const Eigen::Matrix<double, 2, 3> d_rotation = p.transfer.d_rotation();
  const Eigen::Matrix<double, 2, 3> d_translation = p.transfer.d_translation();
  Row J = Row::Zero(2, std::ssize(shared.columns));
  Index c = UnknownsLayout::size_of_plane(track.plane);
  J.leftCols<2>() = p.transfer.d_normal() * p.at.tangents;
  if (track.plane > 0) J.col(2) = p.d_height;
  if (frame > 0) J.middleCols(c, layout_.shared.gyro) = d_rotation * shared.gyro;
  c += layout_.shared.gyro;
  if (layout_.row_delay > 0) {
    const Vector3d rate = velocity.rotation_rad_s + p.seconds * velocity.rotation_rad_s2;
    const Vector3d tau_s = shared.at_stamp.R_cw * (velocity.tau_s + p.seconds * velocity.tau_s2);
    J.col(c++) = window_.readout_direction.dot(p.transfer.pixel) *
                 (d_rotation * rate + d_translation * tau_s);
  }
  for (int k = 0; k < layout_.lens_parameters; ++k)
    J.col(c++) = -lens_moves_px_[k][frame].col(track.column);
  J.row(0).segment<kMonomials>(c) = p.lens;
  J.row(1).segment<kMonomials>(c + kMonomials) = p.lens;
  c += kLensTerms;
  if (layout_.velocity > 0) {
    J.middleCols<3>(c) = p.seconds * d_rotation;
    J.middleCols<3>(c + 3) = p.seconds * d_translation * shared.at_stamp.R_cw;
    c += layout_.velocity;
  }
  if (frame == 0) return J;
  if (layout_.own == 6) J.middleCols<3>(c) = d_rotation;
  J.rightCols<3>() = d_translation;
  return J;
}

// Observations of one plane in one frame have the same unknowns: one product serves them all.
void Model::add_group(const State& state,
                      std::span<const std::pair<int, Track::Seen>> group,
                      const Scales& scales,
                      Curvature curvature,
                      Normals& all) const {
  const int frame = group.front().second.frame;
  const int plane = tracks_[group.front().first].plane;
  const Shared shared{.frame = frame,
                      .at_stamp = frame_state(observations_, state.motion, frame, plane),
                      .gyro = layout_.shared.gyro > 0
                                  ? gyro_columns(window_, state.motion, frame, layout_.shared.gyro)
                                  : GyroColumns(3, 0),
                      .columns = columns_of(plane, frame)};
  const std::vector<int>& columns = shared.columns;
  const auto width = static_cast<Index>(columns.size());
  const double frame_px = frame == 0 ? scales.reference_px : scales.sigma_px;
  MatrixXd J = MatrixXd::Zero(width, 2 * std::ssize(group));
  for (Index o = 0; o < std::ssize(group); ++o) {
    const auto& [j, seen] = group[o];
    const Prediction p = predict(state, shared.at_stamp, j, seen);
    const double sigma_px = frame_px * noise_ratio(j, frame);
    // A track may be far off in the reference frame without being wrong in the others.
    const ObservationNoise noise{sigma_px, std::pow(scales.sigma_px / sigma_px, 2), frame > 0};
    const Weights weights = weights_of(p.r, noise, options_.huber, curvature);
    all.cost += weights.cost;
    if (!(weights.gradient > 0)) continue;
    all.in_front = all.in_front && p.transfer.in_front();
    const Row unweighted = jacobian(state, p, tracks_[j], shared);
    const Matrix2d unweighted_x = p.jacobian_of_latent();
    const Vector2d r = weights.gradient * p.r;
    const Row weighted = weights.root * unweighted;
    const Matrix2d weighted_x = weights.root * unweighted_x;
    J.middleCols<2>(2 * o) = weighted.transpose();
    all.V[j] += weighted_x.transpose() * weighted_x;
    all.v[j] += unweighted_x.transpose() * r;
    for (Index c = 0; c < width; ++c) {
      all.by_track(columns[c], j) += unweighted.col(c).dot(r);
      all.E.block<1, 2>(columns[c], 2 * j) += weighted.col(c).transpose() * weighted_x;
    }
  }
  MatrixXd JJ = MatrixXd::Zero(width, width);
  JJ.selfadjointView<Eigen::Lower>().rankUpdate(J);
  JJ.triangularView<Eigen::StrictlyUpper>() = JJ.transpose();
  for (Index a = 0; a < width; ++a)
    for (Index b = 0; b < width; ++b) all.A(columns[a], columns[b]) += JJ(a, b);
}

Normals Model::linearize(const State& state, const Scales& scales, Curvature curvature) const {
  const Index size = layout_.size();
  const Index count = std::ssize(tracks_);
  Normals all{.A = MatrixXd::Zero(size, size),
              .by_track = MatrixXd::Zero(size, count),
              .E = MatrixXd::Zero(size, 2 * count),
              .V = std::vector<Matrix2d>(count, Matrix2d::Zero()),
              .v = std::vector<Vector2d>(count, Vector2d::Zero())};
  std::vector<std::vector<std::pair<int, Track::Seen>>> groups(layout_.planes * layout_.frames);
  for (int j = 0; j < count; ++j)
    for (const Track::Seen& seen : tracks_[j].seen)
      groups[tracks_[j].plane * layout_.frames + seen.frame].emplace_back(j, seen);
  for (const auto& group : groups)
    if (!group.empty()) add_group(state, group, scales, curvature, all);
  MatrixXd half(size, 2 * count);
  for (Index j = 0; j < count; ++j) {
    if (!(all.V[j].trace() > 0)) all.V[j].setIdentity();  // all observations are beyond the gate
    const auto E = all.E.middleCols<2>(2 * j);
    half.middleCols<2>(2 * j) =
        Eigen::LLT<Matrix2d>(all.V[j]).matrixL().solve(E.transpose()).transpose();
    all.by_track.col(j) -= E * (all.V[j].inverse() * all.v[j]);
  }
  all.A.selfadjointView<Eigen::Lower>().rankUpdate(half, -1);
  all.A.triangularView<Eigen::StrictlyUpper>() = all.A.transpose();
  return all;
}

State Model::moved(const State& from,
                   const VectorXd& x,
                   const Normals& at,
                   const Scales& scales) const {
  State to = from;
  PlaneMotion& motion = to.motion;
  motion.normal = moved_normal(motion.normal, x.head<2>());
  for (int k = 1; k < layout_.planes; ++k) {
    Vector3d& m = motion.others[k - 1].m;
    const Vector3d u_s = x.segment<3>(UnknownsLayout::of_plane(k));
    const double length = m.norm();
    m = length * std::exp(u_s(2)) * moved_normal(m / length, u_s.head<2>());
  }
  const Index gyro = layout_.shared.of_gyro();
  if (layout_.shared.gyro > 0) motion.bias_rad_s += x.segment<3>(gyro);
  if (layout_.shared.gyro == 4) motion.time_offset_s += x(gyro + 3);
  if (layout_.row_delay > 0) to.row_delay_s += x(layout_.at_row_delay());
  to.lens += x.segment<kLensTerms>(layout_.at_lens());
  for (int i = 1; i < layout_.frames; ++i) {
    motion.tau[i] += from.motion.R_wc[i] * x.segment<3>(layout_.at_translation(i));
    if (layout_.own == 6) {
      const Matrix3d turn = so3_exp(x.segment<3>(layout_.at_frame(i)));
      if (options_.gyro_noise)
        motion.gyro_noise_rad[i] = so3_log(so3_exp(motion.gyro_noise_rad[i]) * turn);
      else
        motion.R_wc[i] = motion.R_wc[i] * turn;
    }
    if (layout_.shared.gyro > 0) motion.R_wc[i] = gyro_rotation(window_, i, motion);
  }
  for (Index j = 0; j < std::ssize(tracks_); ++j)
    to.shift_px.col(j) -= at.V[j].inverse() * (at.v[j] + at.E.middleCols<2>(2 * j).transpose() * x);
  update_velocities(to, path_noise(at, scales));
  return to;
}

}  // namespace gpo::joint
