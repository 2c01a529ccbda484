// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/certainty/uncertainty.h"

#include "engine/initializers/common/window_checks.h"
#include "engine/initializers/plane/plane_motion.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using OwnMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
using MixedMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

int shared_size(RotationModel model) { return model == RotationModel::bias ? 5 : 2; }

/// A frame's information over what it shares (normal, bias) and what is its own (phi where the
/// rotations are free, translation last).
struct SplitInformation {
  SharedInformation ss;
  MixedMatrix so;
  OwnMatrix oo;
};

SplitInformation split(const Window& window,
                       int frame,
                       const FrameNormals& normals,
                       RotationModel model) {
  const auto& F = normals.JtJ;
  if (model == RotationModel::free)
    return {F.topLeftCorner<2, 2>(), F.topRightCorner<2, 6>(), F.bottomRightCorner<6, 6>()};
  Eigen::Matrix<double, 5, Eigen::Dynamic, 0, 5, 5> M;
  M.setZero(5, shared_size(model));
  M.topLeftCorner<2, 2>().setIdentity();
  if (model == RotationModel::bias) M.bottomRightCorner<3, 3>() = window.gyro->d_bias[frame];
  return {M.transpose() * F.topLeftCorner<5, 5>() * M,
          M.transpose() * F.topRightCorner<5, 3>(),
          F.bottomRightCorner<3, 3>()};
}

/// The inverse, where the matrix is positive definite beyond rounding once its rows are scaled.
std::optional<Eigen::MatrixXd> inverse_of(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return std::nullopt;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  if (!(eigen.eigenvalues()(0) > 1e-12)) return std::nullopt;
  const Eigen::MatrixXd inverse = eigen.eigenvectors() *
                                  eigen.eigenvalues().cwiseInverse().asDiagonal() *
                                  eigen.eigenvectors().transpose();
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

int unknown_count(int frames, RotationModel model) {
  const int own = model == RotationModel::free ? 6 : 3;
  return shared_size(model) + own * (frames - 1);
}

struct Linearization {
  std::vector<FrameNormals> frames;
  double sigma_px = 0;
};

std::optional<Linearization> linearize(const Window& window,
                                       const PlaneMotion& motion,
                                       RotationModel model) {
  const PlaneObservations observations = plane_observations(window);
  Linearization all;
  all.frames.resize(window.frame_count());
  double cost = 0;
  for (int i = 1; i < window.frame_count(); ++i) {
    all.frames[i] =
        frame_normals(observations.frames[i], frame_state(observations, motion, i), Rotating::yes);
    if (!all.frames[i].in_front) return std::nullopt;
    cost += all.frames[i].cost;
  }
  all.sigma_px =
      noise_px(2 * cost, 2 * observations.count(), unknown_count(window.frame_count(), model));
  return all;
}

SharedInformation information_of(const Window& window,
                                 const Linearization& linearized,
                                 RotationModel model) {
  SharedInformation sum = prior_information(window, model, linearized.sigma_px);
  for (int i = 1; i < window.frame_count(); ++i)
    sum += frame_information(window, i, linearized.frames[i], model);
  return sum;
}

/// Of what the frames share.
std::optional<Eigen::MatrixXd> covariance_of(const Window& window,
                                             const Linearization& linearized,
                                             RotationModel model) {
  auto inverse = inverse_of(information_of(window, linearized, model));
  if (inverse) *inverse *= linearized.sigma_px * linearized.sigma_px;
  return inverse;
}

/// Of normal and bias where the bias is held at its prior's mean: an error db of it moves the
/// normal by -A_uu^-1 A_ub db, besides the noise.
std::optional<Eigen::MatrixXd> covariance_of_held_bias(const Window& window,
                                                       const Linearization& linearized) {
  const SharedInformation A = information_of(window, linearized, RotationModel::bias);
  const auto noise = inverse_of(A.topLeftCorner<2, 2>());
  if (!noise) return std::nullopt;
  const double sigma_bias = window.gyro->prior_sigma_rad_s;
  const Eigen::Matrix<double, 2, 3> moves = -*noise * A.topRightCorner<2, 3>();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(5, 5);
  covariance.bottomRightCorner<3, 3>().diagonal().setConstant(sigma_bias * sigma_bias);
  covariance.topRightCorner<2, 3>() = sigma_bias * sigma_bias * moves;
  covariance.bottomLeftCorner<3, 2>() = covariance.topRightCorner<2, 3>().transpose();
  covariance.topLeftCorner<2, 2>() = linearized.sigma_px * linearized.sigma_px * *noise +
                                     sigma_bias * sigma_bias * moves * moves.transpose();
  return covariance;
}

/// Covariances of a frame's camera center and of its distance ratio 1 - n.tau.
void add_frame(const PlaneMotion& motion,
               int frame,
               const SplitInformation& f,
               const Eigen::MatrixXd& shared_covariance,
               Uncertainty& result) {
  const double variance = result.sigma_px * result.sigma_px;
  const OwnMatrix inverse =
      OwnMatrix(f.oo.ldlt().solve(OwnMatrix::Identity(f.oo.rows(), f.oo.rows())));
  const Eigen::MatrixXd gain = inverse * f.so.transpose();
  const Eigen::MatrixXd own = variance * inverse + gain * shared_covariance * gain.transpose();
  const Eigen::MatrixXd cross = -shared_covariance * gain.transpose();
  const Matrix3d t = own.bottomRightCorner<3, 3>();
  const Eigen::Matrix<double, 2, 3> ut = cross.topRightCorner<2, 3>();
  const Matrix3d& R = motion.R_wc[frame];
  result.center_covariances.emplace_back(R * t * R.transpose());
  const Eigen::Vector2d d_u = -(normal_tangents(motion.normal).transpose() * motion.tau[frame]);
  const Vector3d d_t = -(R.transpose() * motion.normal);
  const double ratio_variance = d_u.dot(shared_covariance.topLeftCorner<2, 2>() * d_u) +
                                2 * d_u.dot(ut * d_t) + d_t.dot(t * d_t);
  result.distance_ratio_sigmas.push_back(std::sqrt(std::max(0.0, ratio_variance)));
}

}  // namespace

SharedInformation prior_information(const Window& window, RotationModel model, double sigma_px) {
  const int size = shared_size(model);
  SharedInformation prior = SharedInformation::Zero(size, size);
  if (model == RotationModel::bias) {
    const double ratio = sigma_px / window.gyro->prior_sigma_rad_s;
    prior.diagonal().tail<3>().setConstant(ratio * ratio);
  }
  return prior;
}

SharedInformation frame_information(const Window& window,
                                    int frame,
                                    const FrameNormals& normals,
                                    RotationModel model) {
  const SplitInformation f = split(window, frame, normals, model);
  return f.ss - f.so * f.oo.ldlt().solve(f.so.transpose());
}

std::optional<double> normal_sigma_deg(const SharedInformation& information, double sigma_px) {
  const auto covariance = inverse_of(information);
  if (!covariance) return std::nullopt;
  return degrees(sigma_px * std::sqrt(covariance->topLeftCorner<2, 2>().trace()));
}

std::optional<Uncertainty> uncertainty_of(const Window& window,
                                          const Plane& plane,
                                          std::span<const Pose> cameras,
                                          RotationModel model) {
  const PlaneMotion motion = motion_of(plane, cameras);
  const auto linearized = linearize(window, motion, model);
  if (!linearized) return std::nullopt;
  const bool holds_gyro = model == RotationModel::known && window.gyro;
  const auto shared = holds_gyro ? covariance_of_held_bias(window, *linearized)
                                 : covariance_of(window, *linearized, model);
  if (!shared) return std::nullopt;
  const Eigen::MatrixXd& covariance = *shared;
  const RotationModel moving = holds_gyro ? RotationModel::bias : model;
  Uncertainty result;
  result.sigma_px = linearized->sigma_px;
  result.rotations = model;
  const auto tangents = normal_tangents(motion.normal);
  result.normal_covariance = tangents * covariance.topLeftCorner<2, 2>() * tangents.transpose();
  result.normal_sigma_deg = degrees(std::sqrt(result.normal_covariance.trace()));
  result.center_covariances.emplace_back(Matrix3d::Zero());
  result.distance_ratio_sigmas.push_back(0);
  for (int i = 1; i < window.frame_count(); ++i) {
    add_frame(motion, i, split(window, i, linearized->frames[i], moving), covariance, result);
  }
  if (model == RotationModel::bias) result.bias_covariance = covariance.bottomRightCorner<3, 3>();
  const auto bound_deg = [&](RotationModel of) {
    return normal_sigma_deg(information_of(window, *linearized, of), result.sigma_px);
  };
  result.bound_known_rotations_deg = bound_deg(RotationModel::known);
  if (window.gyro) result.bound_unknown_bias_deg = bound_deg(RotationModel::bias);
  return result;
}

}  // namespace gpo
