// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/joint/joint_model.h"

#include "engine/methods/plane/plane_weights.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo::joint {

using Eigen::Index, Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// Weights of an observation: of its gradient and, as a root, of its second derivatives.
struct Weights {
  double gradient = 0;
  Matrix2d root = Matrix2d::Zero();
  double cost = 0;
};

/// Noise of an observation, and its weight against typical ones of the other frames.
struct Noise {
  double sigma_px = 1;
  double scale = 1;
  bool gated = true;
};

Weights weights_of(const Vector2d& r, const Noise& noise, bool huber, Curvature curvature) {
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
      observations_(observations),
      options_(options),
      image_px_(std::hypot(window.K(0, 2), window.K(1, 2))) {
  lay_out();
  gather_tracks();
  if (options.gyro_noise) walk_ = walk_information(start);
  if (options.row_delay) path_times_ = path_times(window.timestamps_ns);
}

void Model::lay_out() {
  layout_.shared = {static_cast<int>(observations_.others.size()),
                    gyro_unknowns(window_, options_.rotations)};
  layout_.row_delay = options_.row_delay && options_.row_delay->sigma_s > 0 ? 1 : 0;
  layout_.typical_lens = window_.lens_moves_px.empty();
  if (options_.lens_parameters && lens_moves_px_.empty())
    lens_moves_px_ = layout_.typical_lens ? typical_lens_moves_px(window_) : window_.lens_moves_px;
  layout_.lens_parameters = options_.lens_parameters ? static_cast<int>(lens_moves_px_.size()) : 0;
  layout_.lens = options_.lens_residual ? kLensTerms : 0;
  layout_.planes = observations_.plane_count();
  layout_.own = options_.rotations == RotationModel::free || options_.gyro_noise ? 6 : 3;
  layout_.frames = window_.frame_count();
  layout_.velocity = options_.velocity;
}

Model Model::with(const Options& options) const {
  Model other = *this;
  other.options_ = options;
  other.lay_out();
  return other;
}

LensResidual Model::lens_residual(const State& state) const {
  return {state.lens.reshaped(kLensMonomials, 2), image_px_};
}

void Model::gather_tracks() {
  for (int k = 0; k < layout_.planes; ++k) {
    const std::size_t reference = groups_.size();
    groups_.push_back({.plane = k, .frame = 0, .tracks = {}});
    std::vector<int> place(window_.track_count(), -1);
    for (int i = 1; i < layout_.frames; ++i) {
      const FrameObservations& f = observations_.plane(k)[i];
      std::vector<int> tracks;
      for (int o = 0; o < f.count; ++o) {
        int& at = place[f.track[o]];
        if (at < 0) {
          at = static_cast<int>(tracks_.size());
          const Vector2d reference_px(f.ray_x[o] * observations_.fx, f.ray_y[o] * observations_.fy);
          tracks_.push_back({f.track[o], reference_px});
          groups_[reference].tracks.push_back(at);
        }
        tracks.push_back(at);
      }
      groups_.push_back({.plane = k, .frame = i, .tracks = std::move(tracks)});
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
    const auto block = at.A.block(own, own, layout_.own, layout_.own);
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6> inverse = block.inverse();
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
    state.velocities = smooth_velocities(path_times_, state.motion, noise);
  else
    state.velocities.assign(layout_.frames, {});
}

Vector2d Model::observed_px(const Group& group, int observation) const {
  if (group.frame == 0) return tracks_[group.tracks[observation]].reference_px;
  const FrameObservations& f = observations_.plane(group.plane)[group.frame];
  return {f.u[observation], f.v[observation]};
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
  add(layout_.at_lens(), layout_.lens);
  add(layout_.at_velocity(frame), layout_.velocity);
  if (frame > 0) add(layout_.at_frame(frame), layout_.own);
  return columns;
}

void Model::predict_group(const State& state,
                          const Group& group,
                          std::vector<Prediction>& all) const {
  const bool has_lens = !state.lens.isZero(0);
  const LensResidual lens = lens_residual(state);
  FrameState at = frame_state(observations_, state.motion, group.frame, group.plane);
  const FrameState at_stamp = at;
  const Velocity& velocity = state.velocities[group.frame];
  const Vector3d tau_s = at.R_cw * velocity.tau_s, tau_s2 = at.R_cw * velocity.tau_s2;
  const Vector2d per_px(1 / at.fx, 1 / at.fy);
  all.resize(group.tracks.size());
  for (std::size_t o = 0; o < all.size(); ++o) {
    const int j = group.tracks[o];
    const Vector2d observed = observed_px(group, static_cast<int>(o));
    Prediction& p = all[o];
    p.seconds = state.row_delay_s * window_.row_of(group.frame, tracks_[j].column);
    if (state.row_delay_s != 0) {  // when the frame reads the row
      const Matrix3d turn = so3_exp(-velocity.rotation_rad(p.seconds));
      const double half = 0.5 * p.seconds * p.seconds;
      at.tau_c.noalias() = turn * (at_stamp.tau_c + p.seconds * tau_s + half * tau_s2);
      at.R_cw.noalias() = turn * at_stamp.R_cw;
    }
    const Vector2d latent = (tracks_[j].reference_px + state.shift_px.col(j)).cwiseProduct(per_px);
    p.transfer = transfer_on_plane(at, Vector3d(latent.x(), latent.y(), 1));
    p.d_latent = p.transfer.d_reference(at);
    p.r = p.transfer.pixel - observed;
    if (!has_lens) continue;
    // At the predicted pixel: the noise of the observed one is correlated with the error.
    p.r += lens.error_px(p.transfer.pixel);
  }
}

void Model::predict(const State& state, Predictions& all) const {
  all.resize(groups_.size());
  for (std::size_t g = 0; g < groups_.size(); ++g) predict_group(state, groups_[g], all[g]);
}

Model::Shared Model::shared_by(const State& state, const Group& group) const {
  const int gyro = layout_.shared.gyro;
  Shared shared{
      .plane = group.plane,
      .frame = group.frame,
      .turns = gyro > 0 || layout_.own == 6 || layout_.velocity == 6,
      .at_stamp = frame_state(observations_, state.motion, group.frame, group.plane),
      .gyro = gyro > 0 ? gyro_columns(window_, state.motion, group.frame, gyro) : GyroColumns(3, 0),
      .velocity = state.velocities[group.frame],
      .columns = columns_of(group.plane, group.frame),
      .in_panel = {}};
  for (const Index at : shared.columns)
    shared.in_panel.push_back(place_in_panel(at, 2 * std::ssize(tracks_)));
  return shared;
}

void Model::differentiate(const Prediction& p,
                          const Track& track,
                          const Shared& shared,
                          Rows& J) const {
  const Transfer& at = p.transfer;
  const Eigen::Matrix<double, 3, 2> d_y = at.d_y.transpose();
  const Eigen::Matrix<double, 3, 2> d_translation = -at.height * d_y;
  Eigen::Matrix<double, 3, 2> d_rotation;
  if (shared.turns) d_rotation = at.d_rotation().transpose();
  J.setZero(std::ssize(shared.columns), 2);
  const Vector2d along = shared.at_stamp.tangents.transpose() * at.ray_1;
  J.topRows<2>() = -along * (at.tau_c.transpose() * d_y);
  Index c = UnknownsLayout::size_of_plane(shared.plane);
  // A point that is nearer by a share of its distance.
  if (shared.plane > 0) J.row(2) = at.tau_c.transpose() * d_translation;
  if (layout_.shared.gyro > 0 && shared.frame > 0)
    J.middleRows(c, layout_.shared.gyro) = shared.gyro.transpose() * d_rotation;
  c += layout_.shared.gyro;
  const Velocity& velocity = shared.velocity;
  if (layout_.row_delay > 0) {
    const Vector3d rate = velocity.rotation_rad_s + p.seconds * velocity.rotation_rad_s2;
    const Vector3d tau_s = shared.at_stamp.R_cw * (velocity.tau_s + p.seconds * velocity.tau_s2);
    const Vector3d y_s = at.y.cross(rate) - at.height * tau_s;
    // The observed row has the noise of the error; the predicted one has not.
    const double row =
        window_.row_of(shared.frame, track.column) + window_.readout_direction.dot(p.r);
    J.row(c++) = row * (y_s.transpose() * d_y);
  }
  for (int k = 0; k < layout_.lens_parameters; ++k)
    J.row(c++) = -lens_moves_px_[k][shared.frame].col(track.column).transpose();
  if (layout_.lens > 0) {
    const LensMonomials lens = lens_monomials(at.pixel / image_px_);
    J.col(0).segment<kLensMonomials>(c) = lens;
    J.col(1).segment<kLensMonomials>(c + kLensMonomials) = lens;
    c += kLensTerms;
  }
  if (layout_.velocity > 0) {
    J.middleRows<3>(c) = p.seconds * shared.at_stamp.R_cw.transpose() * d_translation;
    if (layout_.velocity == 6) J.middleRows<3>(c + 3) = p.seconds * d_rotation;
    c += layout_.velocity;
  }
  if (shared.frame == 0) return;
  if (layout_.own == 6) J.middleRows<3>(c) = d_rotation;
  J.bottomRows<3>() = d_translation;
}

// Observations of one plane in one frame have the same unknowns: one product serves them all.
/// Adds J J^T to the lower triangle of A, over the unknowns of `columns`.
static void add_self_product(const Panels& J, const std::vector<int>& columns, MatrixXd& A) {
  const auto width = static_cast<Index>(columns.size());
  MatrixXd minus_JJ = MatrixXd::Zero(width, width);
  subtract_self_product(J, minus_JJ);
  for (Index a = 0; a < width; ++a) {
    for (Index b = a; b < width; ++b) {
      const auto [column, row] = std::minmax(columns[a], columns[b]);
      A(row, column) -= minus_JJ(b, a);
    }
  }
}

int Model::add_group(const Shared& shared,
                     const Group& group,
                     std::span<const Prediction> predictions,
                     const Weighting& weighting,
                     Normals& all) const {
  const auto& [scales, curvature] = weighting;
  const std::vector<int>& columns = shared.columns;
  const auto width = static_cast<Index>(columns.size());
  const double frame_px = group.frame == 0 ? scales.reference_px : scales.sigma_px;
  const bool by_track = all.by_track.size() > 0;
  const Index observed = 2 * std::ssize(group.tracks);
  Panels J(kPanel, panel_count(width) * observed);
  J.rightCols(observed).setZero();
  int weighted = 0;
  Rows rows;
  for (Index o = 0; o < std::ssize(group.tracks); ++o) {
    const int j = group.tracks[o];
    const Prediction& p = predictions[o];
    const double sigma_px = frame_px * noise_ratio(j, group.frame);
    // A track may be far off in the reference frame without being wrong in the others.
    const Noise noise{sigma_px, std::pow(scales.sigma_px / sigma_px, 2), group.frame > 0};
    const Weights weights = weights_of(p.r, noise, options_.huber, curvature);
    all.cost += weights.cost;
    if (!(weights.gradient > 0)) {
      for (Index p = 0; p < J.cols(); p += observed) J.middleCols<2>(p + 2 * o).setZero();
      continue;
    }
    all.curvature += 0.5 * weights.root.squaredNorm() / noise.scale;
    ++weighted;
    all.in_front = all.in_front && p.transfer.in_front();
    differentiate(p, tracks_[j], shared, rows);
    const Vector2d r = weights.gradient * p.r;
    const Matrix2d weighted_x = weights.root * p.d_latent;
    const Matrix2d h = weights.root * weighted_x;
    all.V[j] += weighted_x.transpose() * weighted_x;
    all.v[j] += p.d_latent.transpose() * r;
    if (group.frame == 0)
      all.reference_weights[j] = weights.gradient;
    else
      all.latent_weights[j] += weights.gradient * (p.d_latent.transpose() * p.d_latent);
    const Matrix2d& root = weights.root;
    for (Index c = 0; c < width; ++c) {
      const double x = rows(c, 0), y = rows(c, 1);
      double* const in_J = &J.coeffRef(c % kPanel, c / kPanel * observed + 2 * o);
      in_J[0] = x * root(0, 0) + y * root(1, 0);
      in_J[kPanel] = x * root(0, 1) + y * root(1, 1);
      double* const in_half = all.half.data() + shared.in_panel[c] + 2 * j * kPanel;
      in_half[0] += x * h(0, 0) + y * h(1, 0);
      in_half[kPanel] += x * h(0, 1) + y * h(1, 1);
      const double gradient = x * r(0) + y * r(1);
      all.gradient(columns[c]) += gradient;
      if (by_track) all.by_track(columns[c], j) += gradient;
    }
  }
  add_self_product(J, columns, all.A);
  return weighted;
}

Normals Model::linearize(const State& state,
                         const Predictions& predictions,
                         const Scales& scales,
                         Curvature curvature,
                         Normals all) const {
  const Index size = layout_.size();
  const Index count = std::ssize(tracks_);
  all.A.setZero(size, size);
  all.gradient.setZero(size);
  const bool lens = layout_.lens + layout_.lens_parameters > 0;
  all.by_track.setZero(lens ? size : 0, lens ? count : 0);
  all.half.setZero(kPanel, panel_count(size) * 2 * count);
  for (auto* of_tracks : {&all.V, &all.latent_weights}) of_tracks->assign(count, Matrix2d::Zero());
  all.v.assign(count, Vector2d::Zero());
  all.reference_weights.assign(count, 0);
  all.cost = all.curvature = 0;
  all.in_front = true;
  int weighted = 0;
  for (std::size_t g = 0; g < groups_.size(); ++g)
    weighted += add_group(
        shared_by(state, groups_[g]), groups_[g], predictions[g], {scales, curvature}, all);
  all.curvature /= std::max(1, weighted);
  eliminate_latent_positions(all);
  return all;
}

}  // namespace gpo::joint
