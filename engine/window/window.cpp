// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/window/window.h"

#include "engine/geometry/camera.h"
#include "engine/geometry/decompositions.h"
#include "engine/geometry/homography.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"
#include "engine/geometry/transfer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix2Xd;
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;

/// Inliers of a frame in the reference image and in its own [px].
struct Pairs {
  Matrix2Xd from, to;
};

Pairs inlier_pairs(const Window& window, int frame) {
  const std::vector<int> inliers = window.inlier_tracks(frame);
  return {window.points_px[0](Eigen::all, inliers), window.points_px[frame](Eigen::all, inliers)};
}

std::vector<double> transfer_errors_px(const Matrix3d& H, const Pairs& pairs) {
  std::vector<double> errors;
  for (Eigen::Index k = 0; k < pairs.from.cols(); ++k)
    errors.push_back((transfer(H, pairs.from.col(k)) - pairs.to.col(k)).norm());
  return errors;
}

/// Returns the rotation R_i1 with the least sum |pi(K R_i1 K^-1 p_1) - p_i|^2, by Gauss-Newton from
/// the one that maps the rays best.
Matrix3d best_rotation(const Matrix3d& K, const Pairs& pairs) {
  constexpr int kMostSteps = 5;
  constexpr double kSettled_rad = 1e-7;
  const Matrix3d K_inverse = K.inverse();
  const Matrix3Xd rays_1 = K_inverse * pairs.from.colwise().homogeneous();
  const Matrix3Xd rays_i = K_inverse * pairs.to.colwise().homogeneous();
  const Matrix3d moments =
      rays_i.colwise().normalized() * rays_1.colwise().normalized().transpose();
  FrameState at{.R_cw = nearest_rotation(moments), .fx = K(0, 0), .fy = K(1, 1)};
  const Matrix2Xd seen_px = pairs.to.colwise() - K.topRightCorner<2, 1>();
  for (int step = 0; step < kMostSteps; ++step) {
    Matrix3d JtJ = Matrix3d::Zero();
    Eigen::Vector3d Jtr = Eigen::Vector3d::Zero();
    for (Eigen::Index k = 0; k < rays_1.cols(); ++k) {
      const Transfer there = transfer_on_plane(at, rays_1.col(k));
      const Eigen::Matrix<double, 2, 3> J = there.d_rotation();
      JtJ += J.transpose() * J;
      Jtr += J.transpose() * (there.pixel - seen_px.col(k));
    }
    const Eigen::Vector3d phi = -JtJ.ldlt().solve(Jtr);
    if (!phi.allFinite()) break;
    at.R_cw = so3_exp(-phi) * at.R_cw;
    if (phi.norm() < kSettled_rad) break;
  }
  return at.R_cw;
}

}  // namespace

FrameErrors frame_errors(const Window& window, int frame) {
  if (frame == 0 || window.inlier_count(frame) == 0) return {};
  const Pairs pairs = inlier_pairs(window, frame);
  auto homography = transfer_errors_px(window.H_i1[frame], pairs);
  auto rotation =
      transfer_errors_px(window.K * best_rotation(window.K, pairs) * window.K.inverse(), pairs);
  FrameErrors errors{.inliers = static_cast<int>(homography.size())};
  errors.homography_squares = sum_of_squares(homography);
  errors.rotation_squares = sum_of_squares(rotation);
  errors.homography_px = median(std::move(homography));
  errors.rotation_px = median(std::move(rotation));
  return errors;
}

double Window::gate_factor(int frame, int track) const {
  const double own = noise_ratio_of(frame, track), reference = noise_ratio_of(0, track);
  return std::sqrt(std::max(1.0, 0.5 * (own * own + reference * reference)));
}

int Window::inlier_count(int frame) const {
  return static_cast<int>(std::ranges::count(inlier[frame], true));
}

std::vector<int> Window::inlier_tracks(int frame) const {
  std::vector<int> tracks;
  for (int j = 0; j < track_count(); ++j) {
    if (inlier[frame][j]) tracks.push_back(j);
  }
  return tracks;
}

bool Window::is_inlier_track(int track) const {
  int seen = 0;
  int agreeing = 0;
  for (int i = 1; i < frame_count(); ++i) {
    seen += points_px[i].col(track).allFinite() ? 1 : 0;
    agreeing += inlier[i][track] ? 1 : 0;
  }
  return agreeing > 0 && 2 * agreeing >= seen;
}

std::optional<int> Window::plane_of(int track) const {
  for (int k = 0; k < static_cast<int>(planes.size()); ++k)
    if (std::ranges::binary_search(planes[k].tracks, track)) return k;
  return std::nullopt;
}

void refine_homographies(Window& window) {
  constexpr int kLeastInliers = 8;
  for (int i = 1; i < window.frame_count(); ++i) {
    const Pairs pairs = inlier_pairs(window, i);
    Matrix3d& H = window.H_i1[i];
    if (pairs.from.cols() >= kLeastInliers && H.allFinite())
      H = refine_homography(H, pairs.from, pairs.to);
  }
}

double homography_error_px(const Window& window) {
  std::vector<double> errors;
  for (int i = 1; i < window.frame_count(); ++i) {
    auto of_frame = transfer_errors_px(window.H_i1[i], inlier_pairs(window, i));
    errors.push_back(of_frame.empty() ? 0 : median(std::move(of_frame)));
  }
  return median(std::move(errors));
}

bool is_lost(const Window& window, int frame, int track) {
  const auto seen = [&](int i) { return window.points_px[i].col(track).allFinite(); };
  return seen(0) && !seen(frame);
}

int lost_count(const Window& window, int frame) {
  int lost = 0;
  for (int track = 0; track < window.track_count(); ++track)
    lost += is_lost(window, frame, track) ? 1 : 0;
  return lost;
}

Eigen::Vector2d image_size_px(const Window& window) {
  if (window.width > 0 && window.height > 0) return Eigen::Vector2d(window.width, window.height);
  const Eigen::Vector2d center = window.K.topRightCorner<2, 1>();
  if (center.minCoeff() > 0) return 2 * center + Eigen::Vector2d::Ones();
  return window.K(0, 0) * Eigen::Vector2d(1, 0.75);
}

double pixel_unit(const Window& window) {
  return window.width == 0 || window.height == 0
             ? pixel_unit(window.K)
             : pixel_unit(Camera{.width = window.width, .height = window.height});
}

std::vector<std::vector<Eigen::Matrix2Xd>> typical_lens_moves_px(const Window& window) {
  const Eigen::Vector2d center = window.K.topRightCorner<2, 1>();
  const Eigen::Vector2d size_px = image_size_px(window);
  const double corner_px = 0.5 * size_px.norm();
  const double focal_share = window.camera_is_guess ? 0.2 : kTypicalLensShare;
  const double center_share = window.camera_is_guess ? 0.02 : kTypicalLensShare;
  const double moved_px = window.camera_is_guess ? 0.03 * corner_px : 0.5 * pixel_unit(window);
  std::vector<std::vector<Eigen::Matrix2Xd>> moves(5);
  for (const Eigen::Matrix2Xd& points : window.points_px) {
    const Eigen::Matrix2Xd p = points.colwise() - center;
    const Eigen::RowVectorXd r2 = p.colwise().squaredNorm() / (corner_px * corner_px);
    const Eigen::Matrix2Xd cubic = moved_px / corner_px * (p * r2.asDiagonal());
    moves[0].push_back(focal_share * p);
    for (int axis = 0; axis < 2; ++axis) {
      Eigen::Matrix2Xd shift = Eigen::Matrix2Xd::Zero(2, p.cols());
      shift.row(axis).setConstant(center_share * size_px.x());
      moves[1 + axis].push_back(std::move(shift));
    }
    moves[3].push_back(cubic);
    moves[4].push_back(cubic * r2.asDiagonal());
  }
  return moves;
}

}  // namespace gpo
