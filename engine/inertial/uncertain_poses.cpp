// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inertial/uncertain_poses.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <Eigen/Eigenvalues>

namespace gpo {
namespace {

using Eigen::Matrix3d;

/// The symmetric root, negative eigenvalues as zero.
Matrix3d root_of(const Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(covariance);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
         eigen.eigenvectors().transpose();
}

/// A camera's place at the plane's distance, as independent residuals of that size tell it.
double center_sigma(const Window& window, const Initialization& result) {
  constexpr double kLeastTracks = 8;
  const double tracks = std::max(kLeastTracks, static_cast<double>(result.points.size()));
  return result.rms_px / window.K(0, 0) / std::sqrt(tracks) * 3;
}

}  // namespace

Eigen::MatrixXd covariance_from_single_ones(const std::vector<Matrix3d>& of_centers) {
  constexpr std::ptrdiff_t kFirstFew = 4;
  const auto frames = static_cast<Eigen::Index>(of_centers.size());
  const auto least =
      std::min_element(of_centers.begin() + 1,
                       of_centers.begin() + std::min<std::ptrdiff_t>(frames, 1 + kFirstFew),
                       [](const Matrix3d& a, const Matrix3d& b) { return a.trace() < b.trace(); });
  std::vector<Matrix3d> shared(frames);
  for (Eigen::Index i = 1; i < frames; ++i) shared[i] = root_of(of_centers[i] - *least);
  Eigen::MatrixXd all(3 * (frames - 1), 3 * (frames - 1));
  for (Eigen::Index i = 1; i < frames; ++i)
    for (Eigen::Index j = 1; j < frames; ++j)
      all.block<3, 3>(3 * (i - 1), 3 * (j - 1)) = shared[i] * shared[j].transpose();
  for (Eigen::Index i = 1; i < frames; ++i) {
    const Matrix3d own = of_centers[i] - shared[i] * shared[i];
    all.block<3, 3>(3 * (i - 1), 3 * (i - 1)) += root_of(own) * root_of(own);
  }
  return all;
}

UncertainPoses uncertain_poses(const Window& window, const Initialization& result) {
  const int all = window.frame_count();
  const int step = (all - 1 + kMostAlignedFrames - 1) / kMostAlignedFrames;
  UncertainPoses poses;
  std::vector<int> rows;  // of the centers that are taken, in a covariance of all
  for (int i = 0; i < all; i += std::max(1, step)) {
    poses.cameras.push_back(result.cameras[i]);
    poses.times_ns.push_back(window.timestamps_ns[i]);
    for (int axis = 0; i > 0 && axis < 3; ++axis) rows.push_back(3 * (i - 1) + axis);
  }
  poses.bias_rad_s = result.bias_rad_s;
  if (!poses.bias_rad_s && window.gyro) poses.bias_rad_s = window.gyro->bias_rad_s;
  poses.time_offset_s = result.time_offset_s.value_or(0);
  if (!result.uncertainty) {
    const double sigma = center_sigma(window, result);
    poses.covariance =
        sigma * sigma * Eigen::MatrixXd::Identity(std::ssize(rows), std::ssize(rows));
    return poses;
  }
  const Uncertainty& u = *result.uncertainty;
  const int centers = 3 * (all - 1);
  if (u.joint_covariance.rows() >= centers) {
    for (int k = 0; k < u.joint_bias_rows; ++k) rows.push_back(centers + k);
    poses.covariance = u.joint_covariance(rows, rows);
    poses.joint_rows = std::move(rows);
    return poses;
  }
  std::vector<Matrix3d> single = {Matrix3d::Zero()};
  for (std::size_t k = 0; k < rows.size(); k += 3)
    single.push_back(u.center_covariances[rows[k] / 3 + 1]);
  poses.covariance = covariance_from_single_ones(single);
  const auto& of_bias = u.bias_covariance || !window.gyro || u.rotations != RotationModel::known
                            ? u.bias_covariance
                            : std::optional<Matrix3d>(window.gyro->bias_covariance);
  if (!of_bias) return poses;
  const Eigen::Index with_bias = poses.center_rows() + 3;
  poses.covariance.conservativeResizeLike(Eigen::MatrixXd::Zero(with_bias, with_bias));
  poses.covariance.bottomRightCorner<3, 3>() = *of_bias;
  return poses;
}

}  // namespace gpo
