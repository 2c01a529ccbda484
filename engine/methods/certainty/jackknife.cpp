// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/jackknife.h"

#include "engine/methods/certainty/sandwich.h"

#include <algorithm>
#include <cmath>

namespace gpo {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;

constexpr int kColumns = 5;  // regions have two rows
constexpr int kLeastInGroup = 2;
/// A normal farther from that of all tracks is another minimum, such as the twin. The spread is
/// that of one minimum.
constexpr double kOtherMinimum_deg = 15;

/// Returns the group of each track by its region of the reference image, with equal numbers of the
/// tracks that the methods use; -1 for the other tracks.
std::vector<int> regions_of(const Window& window) {
  std::vector<int> tracks;
  for (int j = 0; j < window.track_count(); ++j)
    if (window.all_tracks || window.is_inlier_track(j)) tracks.push_back(j);
  const auto sort = [&](auto begin, auto end, int axis) {
    std::stable_sort(begin, end, [&](int a, int b) {
      return window.points_px[0](axis, a) < window.points_px[0](axis, b);
    });
  };
  std::vector<int> group(window.track_count(), -1);
  if (std::ssize(tracks) < kLeastInGroup * kJackknifeGroups) return group;
  sort(tracks.begin(), tracks.end(), 0);
  const auto part = [&](int k) { return tracks.begin() + std::ssize(tracks) * k / kColumns; };
  for (int column = 0; column < kColumns; ++column) {
    const auto begin = part(column), end = part(column + 1);
    sort(begin, end, 1);
    for (auto track = begin; track != end; ++track)
      group[*track] = 2 * column + (2 * (track - begin) < end - begin ? 0 : 1);
  }
  return group;
}

template <class T>
std::vector<T> picked(const std::vector<T>& values, const std::vector<int>& indices) {
  std::vector<T> all;
  for (const int j : indices) all.push_back(values[j]);
  return all;
}

/// Returns a covariance from the estimates without each group, one per column.
template <int size>
Eigen::Matrix<double, size, size> spread_of_columns(const Eigen::Matrix<double, size, -1>& x) {
  const Eigen::Matrix<double, size, -1> off = x.colwise() - x.rowwise().mean();
  return (kJackknifeGroups - 1.0) / static_cast<double>(x.cols()) * off * off.transpose();
}

/// Returns a covariance of the method's own size and mostly its shape, nowhere below that of the
/// window's noise, because runs do not differ by errors that all regions share. Ten runs determine
/// the shape too badly: squared errors of centers in an ellipsoid of three dimensions would be 5
/// to 8.
MatrixXd shrunk(const MatrixXd& own, const MatrixXd& noise) {
  constexpr double kWindow = 0.25;
  if (!(noise.trace() > 0)) return own;
  const MatrixXd mixed = (1 - kWindow) * own + kWindow * own.trace() / noise.trace() * noise;
  return mixed + power_of_positive(noise - mixed, 1);
}

/// Gives a diagonal block of the joint covariance another covariance, with the same correlations:
/// by the symmetric T with T from T = to.
void reshape(MatrixXd& joint, Eigen::Index at, const MatrixXd& to) {
  const auto rows = Eigen::seqN(at, to.rows());
  MatrixXd from = joint(rows, rows);
  if (!(from.trace() > 0)) return;
  from.diagonal().array() += 1e-11 * from.trace();  // invertible
  const MatrixXd root = power_of_positive(from, 0.5);
  const MatrixXd inverse = power_of_positive(from, -0.5);
  const MatrixXd T = inverse * power_of_positive(root * to * root, 0.5) * inverse;
  joint(rows, Eigen::all) = (T * joint(rows, Eigen::all)).eval();
  joint(Eigen::all, rows) = (joint(Eigen::all, rows) * T).eval();
}

}  // namespace

Window without_tracks(const Window& window, const std::vector<bool>& removed) {
  std::vector<int> kept;
  std::vector<int> place(removed.size(), -1);
  for (int j = 0; j < std::ssize(removed); ++j) {
    if (removed[j]) continue;
    place[j] = static_cast<int>(kept.size());
    kept.push_back(j);
  }
  Window less = window;
  less.lens_moves_px.clear();
  less.row_delay_moves_px.clear();
  for (int i = 0; i < window.frame_count(); ++i) {
    less.points_px[i] = window.points_px[i](Eigen::all, kept);
    less.inlier[i] = picked(window.inlier[i], kept);
    if (!window.noise_ratio.empty()) less.noise_ratio[i] = window.noise_ratio[i](kept).eval();
    if (!window.rows.empty()) less.rows[i] = window.rows[i](kept).eval();
  }
  refine_homographies(less);
  for (WindowPlane& plane : less.planes) {
    std::erase_if(plane.tracks, [&](int j) { return removed[j]; });
    for (int& j : plane.tracks) j = place[j];
    for (std::vector<bool>& inlier : plane.inlier) inlier = picked(inlier, kept);
  }
  if (!less.planes.empty()) less.planes[less.leader].H_i1 = less.H_i1;
  return less;
}

std::optional<NoiseSpread> jackknife(
    const Window& window,
    const Initialization& result,
    const std::function<Initialization(const Window& without_group)>& initialize) {
  const std::vector<int> group = regions_of(window);
  if (std::ranges::max(group) < 0) return std::nullopt;
  const int frames = window.frame_count();
  const auto tangents = normal_tangents(result.plane.normal);
  Eigen::Matrix2Xd normals(2, 0);
  std::vector<Eigen::Matrix3Xd> centers(frames, Eigen::Matrix3Xd(3, 0));
  std::vector<Eigen::RowVectorXd> ratios(frames);
  const auto append = [](auto& columns, const auto& value) {
    columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
    columns.rightCols(1) = value;
  };
  for (int g = 0; g < kJackknifeGroups; ++g) {
    std::vector<bool> removed(group.size());
    for (std::size_t j = 0; j < group.size(); ++j) removed[j] = group[j] == g;
    const Initialization without = initialize(without_tracks(window, removed));
    if (without.stopped) return std::nullopt;
    const Plane& plane = without.plane;
    if (!without.ok || angle_deg(plane.normal, result.plane.normal) > kOtherMinimum_deg) continue;
    append(normals, tangents.transpose() * plane.normal);
    for (int i = 0; i < frames; ++i) {
      const Eigen::Vector3d center = without.cameras[i].p_wc / plane.distance;
      append(centers[i], center);
      ratios[i].conservativeResize(normals.cols());
      ratios[i](normals.cols() - 1) = 1 + plane.normal.dot(center);
    }
  }
  if (2 * normals.cols() <= kJackknifeGroups) return NoiseSpread{.unstable = true};
  NoiseSpread own{.normal = spread_of_columns<2>(normals)};
  for (int i = 0; i < frames; ++i) {
    own.centers.push_back(spread_of_columns<3>(centers[i]));
    own.distance_ratios.push_back(spread_of_columns<1>(ratios[i])(0));
  }
  return own;
}

Uncertainty with_own_noise(Uncertainty u, const Plane& plane, const NoiseSpread& own) {
  const auto N = normal_tangents(plane.normal);
  const Matrix2d others = N.transpose() * u.normal_covariance * N - u.noise.normal;
  const Matrix2d normal = shrunk(own.normal, u.noise.normal) + power_of_positive(others, 1);
  const Eigen::Index rows = u.joint_covariance.rows();
  const Eigen::Index frames = std::ssize(u.center_covariances);
  for (Eigen::Index i = 1; i < frames; ++i) {
    Matrix3d& center = u.center_covariances[i];
    center = shrunk(own.centers[i], u.noise.centers[i]) +
             power_of_positive(center - u.noise.centers[i], 1);
    if (rows > 0) reshape(u.joint_covariance, 3 * (i - 1), center);
    double& sigma = u.distance_ratio_sigmas[i];
    const double more = std::max(0.0, sigma * sigma - u.noise.distance_ratios[i]);
    sigma = std::sqrt(std::max(own.distance_ratios[i], u.noise.distance_ratios[i]) + more);
  }
  if (rows > 0) reshape(u.joint_covariance, 3 * (frames - 1) + u.joint_bias_rows, normal);
  if (auto& typical = u.typical_lens_sigma_deg) {
    const double of_lens = std::pow(radians(*typical), 2) - u.normal_covariance.trace();
    *typical = degrees(std::sqrt(normal.trace() + std::max(0.0, of_lens)));
  }
  u.normal_covariance = N * normal * N.transpose();
  u.normal_sigma_deg = degrees(std::sqrt(normal.trace()));
  u.neighbors_sigma_deg.reset();
  u.noise = own;
  u.own = true;
  return u;
}

}  // namespace gpo
