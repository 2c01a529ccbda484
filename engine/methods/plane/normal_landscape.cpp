// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/normal_landscape.h"

#include "engine/methods/plane/plane_kernel.h"
#include "engine/methods/plane/plane_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr float kOutside = std::numeric_limits<float>::quiet_NaN();
constexpr float kBehind = std::numeric_limits<float>::infinity();
constexpr double kRightAngle = std::numbers::pi / 2;

/// A translation has three unknowns, an observation two equations.
constexpr int kLeastObservationsOfTranslation = 2;

/// Normal equations A(n) tau = b(n) of a frame's translation: with y = R_ciw (x_1 - tau h),
/// h = n.x_1, and rows B = ((f_x, 0, -u), (0, f_y, -v)) R_ciw / y_z,
///   A = sum h^2 B^T B,  b = sum h B^T B x_1,
/// quadratic and linear in n.
struct TranslationEquations {
  std::array<Matrix3d, 6> A;  ///< for n_x^2, n_y^2, n_z^2, n_x n_y, n_x n_z, n_y n_z
  Matrix3d b = Matrix3d::Zero();

  Vector3d tau(const Vector3d& n) const {
    const Matrix3d at = n.x() * n.x() * A[0] + n.y() * n.y() * A[1] + n.z() * n.z() * A[2] +
                        n.x() * n.y() * A[3] + n.x() * n.z() * A[4] + n.y() * n.z() * A[5];
    return at.inverse() * (b * n);
  }
};

/// Takes y_z from the frame's homography: its scale is unknown but cancels.
TranslationEquations translation_equations(const Window& window,
                                           const PlaneObservations& observations,
                                           int frame) {
  TranslationEquations equations;
  equations.A.fill(Matrix3d::Zero());
  const Matrix3d R_cw = window.R_wc[frame].transpose();
  const Vector3d depth = (window.K.inverse() * window.H_i1[frame] * window.K).row(2).transpose();
  const FrameObservations& f = observations.frames[frame];
  for (int k = 0; k < f.count; ++k) {
    const Vector3d x(f.ray_x[k], f.ray_y[k], 1);
    Eigen::Matrix<double, 2, 3> B;
    B << observations.fx, 0, -f.u[k], 0, observations.fy, -f.v[k];
    B = B * R_cw / depth.dot(x);
    const Matrix3d BtB = B.transpose() * B;
    equations.A[0] += x.x() * x.x() * BtB;
    equations.A[1] += x.y() * x.y() * BtB;
    equations.A[2] += BtB;
    equations.A[3] += 2 * x.x() * x.y() * BtB;
    equations.A[4] += 2 * x.x() * BtB;
    equations.A[5] += 2 * x.y() * BtB;
    equations.b += BtB * x * x.transpose();
  }
  return equations;
}

/// Returns the least cost over the translation, from the solution of the linear equations.
float least_cost_px2(const FrameObservations& observations,
                     const TranslationEquations& equations,
                     FrameState state) {
  state.tau_c = state.R_cw * equations.tau(state.normal);
  const FrameNormals at = frame_normals(observations, state, Rotating::no);
  const Vector3d gradient = at.Jtr.tail<3>();
  const double gain = 0.5 * gradient.dot(at.JtJ.bottomRightCorner<3, 3>().llt().solve(gradient));
  const double cost = std::max(0.0, at.cost - gain);
  return at.in_front && std::isfinite(at.cost) ? static_cast<float>(cost) : kBehind;
}

/// Returns the rays of all tracks that are inliers in any frame, 3 x n.
Eigen::Matrix3Xd rays_of_inliers(const Window& window) {
  std::vector<int> tracks;
  for (int j = 0; j < window.track_count(); ++j) {
    if (std::ranges::any_of(window.inlier, [j](const auto& inlier) { return bool{inlier[j]}; }))
      tracks.push_back(j);
  }
  const Eigen::Matrix2Xd points = window.points_px[0](Eigen::all, tracks);
  return window.K.inverse() * points.colwise().homogeneous();
}

}  // namespace

Vector2d disc_from_normal(const Vector3d& normal) {
  const double sine = normal.head<2>().norm();
  if (sine == 0) return Vector2d(normal.z() > 0 ? 2 : 0, 0);
  return std::atan2(sine, -normal.z()) / kRightAngle / sine * normal.head<2>();
}

Vector3d normal_from_disc(const Vector2d& disc) {
  const double radius = disc.norm();
  if (radius == 0) return -Vector3d::UnitZ();
  const Vector2d side = std::sin(kRightAngle * radius) / radius * disc;
  return {side.x(), side.y(), -std::cos(kRightAngle * radius)};
}

Vector2d disc_of_cell(int side, int row, int column) {
  return {(2.0 * column + 1) / side - 1, (2.0 * row + 1) / side - 1};
}

std::optional<NormalLandscape> normal_landscape(const Window& window,
                                                int side,
                                                const std::stop_token& stop) {
  const PlaneObservations observations = plane_observations(window);
  const Eigen::Matrix3Xd rays = rays_of_inliers(window);
  const int frames = window.frame_count();
  const auto cells = static_cast<std::size_t>(side) * side;
  NormalLandscape landscape{
      side, std::vector(frames, std::vector<float>(cells, kOutside)), std::vector<int>(frames, 0)};
  std::vector<TranslationEquations> equations(frames);
  for (int i = 1; i < frames; ++i) {
    landscape.observations[i] = observations.frames[i].count;
    equations[i] = translation_equations(window, observations, i);
  }
  for (int cell = 0; cell < side * side; ++cell) {
    if (cell % side == 0 && stop.stop_requested()) return std::nullopt;
    const Vector2d disc = disc_of_cell(side, cell / side, cell % side);
    FrameState state{.normal = normal_from_disc(disc),
                     .tangents = normal_tangents(normal_from_disc(disc)),
                     .fx = observations.fx,
                     .fy = observations.fy};
    const bool seen = disc.norm() < 1 && !((state.normal.transpose() * rays).array() >= 0).any();
    for (int i = 0; seen && i < frames; ++i) {
      const bool determined = landscape.observations[i] >= kLeastObservationsOfTranslation;
      state.R_cw = window.R_wc[i].transpose();
      landscape.cost_px2[i][cell] =
          determined ? least_cost_px2(observations.frames[i], equations[i], state) : 0;
    }
  }
  return landscape;
}

std::vector<float> rms_px(const NormalLandscape& landscape, int frames) {
  std::vector<double> sum(static_cast<std::size_t>(landscape.side) * landscape.side, 0);
  int observations = 0;
  for (int i = 0; i < frames; ++i) {
    observations += landscape.observations[i];
    for (std::size_t cell = 0; cell < sum.size(); ++cell) sum[cell] += landscape.cost_px2[i][cell];
  }
  std::vector<float> rms;
  rms.reserve(sum.size());
  for (const double cost : sum)
    rms.push_back(static_cast<float>(std::sqrt(2 * cost / std::max(1, observations))));
  return rms;
}

}  // namespace gpo
