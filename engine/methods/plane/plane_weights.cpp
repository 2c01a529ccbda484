// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/plane_weights.h"

#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

void reweigh_frame(const FrameState& state,
                   const MethodOptions& options,
                   double sigma_px,
                   FrameObservations& f) {
  const bool sampson = options.error == ErrorModel::sampson;
  const double knee_px = kHuberSigmas * sigma_px;
  if (sampson) f.weight.assign(f.count, Matrix2d::Identity());
  for (int k = 0; k < f.count; ++k) {
    const Vector2d r = transfer_error_px(f, state, k);
    if (!sampson) {
      f.mask[k] = std::sqrt(huber_weight(r.norm(), knee_px));
      continue;
    }
    const Matrix2d J = transfer_of(f, state, k).d_reference(state);
    f.weight[k] = 2 * (Matrix2d::Identity() + J * J.transpose()).inverse();
    if (options.loss == Loss::huber)
      f.weight[k] *= huber_weight(std::sqrt(r.dot(f.weight[k] * r)), knee_px);
  }
}

FrameNormals sum_of_curved(const FrameObservations& f, const FrameState& state) {
  FrameNormals normals{.in_front = true};
  for (int k = 0; k < f.count; ++k) add_curved(f, state, k, normals);
  return normals;
}

}  // namespace

Transfer transfer_of(const FrameObservations& f, const FrameState& state, int k) {
  return transfer_on_plane(state, Vector3d(f.ray_x[k], f.ray_y[k], 1));
}

Vector2d transfer_error_px(const FrameObservations& f, const FrameState& state, int k) {
  return transfer_of(f, state, k).pixel - Vector2d(f.u[k], f.v[k]);
}

bool is_weighted(const MethodOptions& options) {
  return options.error == ErrorModel::sampson || options.loss != Loss::squared;
}

void reweigh(const PlaneMotion& motion,
             const MethodOptions& options,
             double sigma_px,
             PlaneObservations& observations) {
  for (int k = 0; k < observations.plane_count(); ++k)
    for (int i = 1; i < std::ssize(observations.frames); ++i)
      reweigh_frame(
          frame_state(observations, motion, i, k), options, sigma_px, observations.plane(k)[i]);
}

double loss_beyond_weights(const PlaneMotion& motion,
                           const MethodOptions& options,
                           double sigma_px,
                           const PlaneObservations& observations) {
  if (options.loss != Loss::huber || options.error == ErrorModel::sampson) return 0;
  const double knee_px = kHuberSigmas * sigma_px;
  double sum = 0;
  for (int i = 1; i < std::ssize(observations.frames); ++i) {
    for (int k = 0; k < observations.plane_count(); ++k) {
      const FrameObservations& f = observations.plane(k)[i];
      const FrameState state = frame_state(observations, motion, i, k);
      for (int o = 0; o < f.count; ++o)
        sum += 0.5 * knee_px * std::max(0.0, transfer_error_px(f, state, o).norm() - knee_px);
    }
  }
  return sum;
}

FrameNormals weighted_normals(const FrameObservations& f,
                              const FrameState& state,
                              Rotating rotating) {
  return f.weight.empty() ? frame_normals(f, state, rotating) : sum_of_curved(f, state);
}

Matrix2d weight_of(const FrameObservations& f, int k) {
  return f.weight.empty() ? Matrix2d(f.mask[k] * f.mask[k] * Matrix2d::Identity()) : f.weight[k];
}

Matrix2d curvature_of(const FrameObservations& f, int k, const Vector2d& r) {
  if (!f.weight.empty() || f.mask[k] == 1) return weight_of(f, k);
  const Vector2d along = r.normalized();
  return f.mask[k] * f.mask[k] * (Matrix2d::Identity() - along * along.transpose());
}

void add_curved(const FrameObservations& f, const FrameState& state, int k, FrameNormals& sum) {
  const Transfer transfer = transfer_of(f, state, k);
  const Eigen::Matrix<double, 2, 8> J = transfer.jacobian(state.tangents);
  const Vector2d r = transfer.pixel - Vector2d(f.u[k], f.v[k]);
  const Vector2d weighted = weight_of(f, k) * r;
  const Eigen::Matrix<double, 8, 2> JtC = J.transpose() * curvature_of(f, k, r);
  sum.JtJ.noalias() += JtC * J;
  sum.Jtr.noalias() += J.transpose() * weighted;
  sum.cost += 0.5 * r.dot(weighted);
  sum.in_front = sum.in_front && transfer.in_front();
}

// The sum over all observations of their weights' normal equations, less the curvature along the
// errors beyond the knee.
FrameNormals curved_normals(const FrameObservations& f, const FrameState& state) {
  FrameNormals normals = weighted_normals(f, state, Rotating::yes);
  for (int k = 0; f.weight.empty() && k < f.count; ++k) {
    if (f.mask[k] == 1) continue;
    const Transfer transfer = transfer_of(f, state, k);
    const Vector2d along = (transfer.pixel - Vector2d(f.u[k], f.v[k])).normalized();
    const Eigen::Matrix<double, 8, 1> g =
        f.mask[k] * transfer.jacobian(state.tangents).transpose() * along;
    normals.JtJ.noalias() -= g * g.transpose();
  }
  return normals;
}

}  // namespace gpo
