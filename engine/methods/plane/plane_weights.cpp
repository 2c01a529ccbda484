// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/plane_weights.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kHuberSigmas = 1.345;

/// dp_i/dp_1: the homography's slope where it takes the point.
Matrix2d slope(const FrameState& state, const Transfer& transfer) {
  const Matrix3d A = state.R_cw - state.tau_c * state.normal.transpose();
  return transfer.d_y * A.leftCols<2>() * Vector2d(1 / state.fx, 1 / state.fy).asDiagonal();
}

double huber_weight(double length_px, double sigma_px) {
  return std::min(1.0, kHuberSigmas * sigma_px / std::max(length_px, 1e-12));
}

/// Of Huber's loss alone a weight is a number, which the kernel takes as it does its mask.
void reweigh_by_huber(const FrameState& state, double sigma_px, FrameObservations& f) {
  for (int k = 0; k < f.count; ++k)
    f.mask[k] = std::sqrt(huber_weight(transfer_error_px(f, state, k).norm(), sigma_px));
}

void reweigh(const FrameState& state,
             const MethodOptions& options,
             double sigma_px,
             FrameObservations& f) {
  if (options.error == ErrorModel::transfer) return reweigh_by_huber(state, sigma_px, f);
  f.weight.assign(f.count, Matrix2d::Identity());
  for (int k = 0; k < f.count; ++k) {
    const Matrix2d J = slope(state, transfer_of(f, state, k));
    f.weight[k] = 2 * (Matrix2d::Identity() + J * J.transpose()).inverse();
    if (options.loss != Loss::huber) continue;
    const Vector2d r = transfer_error_px(f, state, k);
    f.weight[k] *= huber_weight(std::sqrt(r.dot(f.weight[k] * r)), sigma_px);
  }
}

}  // namespace

Transfer transfer_of(const FrameObservations& f, const FrameState& state, int k) {
  return transfer_on_plane(state, Vector3d(f.ray_x[k], f.ray_y[k], 1));
}

Vector2d transfer_error_px(const FrameObservations& f, const FrameState& state, int k) {
  return transfer_of(f, state, k).pixel - Vector2d(f.u[k], f.v[k]);
}

bool is_weighted(const MethodOptions& options) {
  return options.error != ErrorModel::transfer || options.loss != Loss::squared;
}

void reweigh(const PlaneMotion& motion,
             const MethodOptions& options,
             double sigma_px,
             PlaneObservations& observations) {
  for (std::size_t i = 1; i < observations.frames.size(); ++i) {
    const int frame = static_cast<int>(i);
    reweigh(frame_state(observations, motion, frame), options, sigma_px, observations.frames[i]);
    for (std::size_t k = 0; k < observations.others.size(); ++k) {
      const FrameState state = frame_state(observations, motion, frame, motion.others[k].m);
      reweigh(state, options, sigma_px, observations.others[k][i]);
    }
  }
}

double loss_beyond_weights(const PlaneMotion& motion,
                           const MethodOptions& options,
                           double sigma_px,
                           const PlaneObservations& observations) {
  if (options.loss != Loss::huber || options.error != ErrorModel::transfer) return 0;
  const double knee_px = kHuberSigmas * sigma_px;
  double sum = 0;
  const auto add = [&](const FrameObservations& f, const FrameState& state) {
    for (int k = 0; k < f.count; ++k)
      sum += 0.5 * knee_px * std::max(0.0, transfer_error_px(f, state, k).norm() - knee_px);
  };
  for (int i = 1; i < static_cast<int>(observations.frames.size()); ++i) {
    add(observations.frames[i], frame_state(observations, motion, i));
    for (std::size_t k = 0; k < observations.others.size(); ++k)
      add(observations.others[k][i], frame_state(observations, motion, i, motion.others[k].m));
  }
  return sum;
}

FrameNormals frame_normals_by_matrix(const FrameObservations& f, const FrameState& state) {
  FrameNormals normals;
  normals.in_front = true;
  for (int k = 0; k < f.count; ++k) {
    const Transfer transfer = transfer_of(f, state, k);
    const Eigen::Matrix<double, 2, 8> J = transfer.jacobian(state.tangents);
    const Vector2d r = transfer.pixel - Vector2d(f.u[k], f.v[k]);
    normals.JtJ += J.transpose() * f.weight[k] * J;
    normals.Jtr += J.transpose() * f.weight[k] * r;
    normals.cost += 0.5 * r.dot(f.weight[k] * r);
    normals.in_front = normals.in_front && transfer.in_front();
  }
  return normals;
}

}  // namespace gpo
