// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/plane/plane_weights.h"

#include "engine/initializers/residuals/transfer.h"

#include <cmath>

#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kHuberSigmas = 1.345;

Matrix3d focal(const FrameState& state) { return Vector3d(state.fx, state.fy, 1).asDiagonal(); }

Transfer transfer_of(const FrameObservations& f, const FrameState& state, int k) {
  return transfer_on_plane(focal(state),
                           state.R_cw.transpose(),
                           Vector3d(f.ray_x[k], f.ray_y[k], 1),
                           state.normal,
                           state.R_cw.transpose() * state.tau_c);
}

/// dp_i/dp_1: the homography's slope where it takes the point.
Matrix2d slope(const FrameObservations& f, const FrameState& state, int k) {
  const Matrix3d H =
      focal(state) * (state.R_cw - state.tau_c * state.normal.transpose()) * focal(state).inverse();
  const Vector3d y = H * Vector3d(state.fx * f.ray_x[k], state.fy * f.ray_y[k], 1);
  return (H.topLeftCorner<2, 2>() - y.hnormalized() * H.bottomLeftCorner<1, 2>()) / y.z();
}

}  // namespace

bool is_weighted(const InitializerOptions& options) {
  return options.error != ErrorModel::transfer || options.loss != Loss::squared;
}

void reweigh(const PlaneMotion& motion,
             const InitializerOptions& options,
             double sigma_px,
             PlaneObservations& observations) {
  for (std::size_t i = 1; i < observations.frames.size(); ++i) {
    FrameObservations& f = observations.frames[i];
    const FrameState state = frame_state(observations, motion, static_cast<int>(i));
    f.weight.assign(f.count, Matrix2d::Identity());
    for (int k = 0; k < f.count; ++k) {
      if (options.error == ErrorModel::sampson) {
        const Matrix2d J = slope(f, state, k);
        f.weight[k] = 2 * (Matrix2d::Identity() + J * J.transpose()).inverse();
      }
      if (options.loss == Loss::huber) {
        const Vector2d r = transfer_of(f, state, k).pixel - Vector2d(f.u[k], f.v[k]);
        const double length = std::sqrt(r.dot(f.weight[k] * r));
        f.weight[k] *= std::min(1.0, kHuberSigmas * sigma_px / std::max(length, 1e-12));
      }
    }
  }
}

FrameNormals frame_normals_by_matrix(const FrameObservations& f, const FrameState& state) {
  FrameNormals normals;
  normals.in_front = true;
  for (int k = 0; k < f.count; ++k) {
    const Transfer transfer = transfer_of(f, state, k);
    Eigen::Matrix<double, 2, 8> J;
    J << transfer.d_normal * state.tangents, transfer.d_rotation,
        transfer.d_tau * state.R_cw.transpose();
    const Vector2d r = transfer.pixel - Vector2d(f.u[k], f.v[k]);
    normals.JtJ += J.transpose() * f.weight[k] * J;
    normals.Jtr += J.transpose() * f.weight[k] * r;
    normals.cost += 0.5 * r.dot(f.weight[k] * r);
    normals.in_front = normals.in_front && transfer.in_front;
  }
  return normals;
}

}  // namespace gpo
