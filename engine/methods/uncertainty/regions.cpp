// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/uncertainty/regions.h"

#include "engine/base/parallel.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/rolling_shutter.h"
#include "engine/methods/uncertainty/information.h"

#include <algorithm>
#include <cmath>
#include <thread>

namespace gpo {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;

/// Share of the analytic shape in the normal's covariance: nine runs determine it badly.
constexpr double kAnalyticShare = 0.25;
/// Ratio of the variance by regions to the analytic one from which neighbors share errors. Chance
/// exceeds it in one of 20 simulated windows.
constexpr double kDisagreement = 3;
constexpr int kSide = 3;
static_assert(kSide * kSide == kRegions);
constexpr int kLeastInRegion = 2;
/// A normal farther from that of all tracks is another minimum, such as the twin. The spread is
/// that of one minimum.
constexpr double kOtherMinimum_deg = 15;

/// Returns the region of each track that the methods use, -1 for the others.
std::vector<int> regions_of(const Window& window) {
  std::vector<int> tracks;
  for (int j = 0; j < window.track_count(); ++j)
    if (window.all_tracks || window.is_inlier_track(j)) tracks.push_back(j);
  const auto sort = [&](auto begin, auto end, int axis) {
    std::stable_sort(begin, end, [&](int a, int b) {
      return window.points_px[0](axis, a) < window.points_px[0](axis, b);
    });
  };
  std::vector<int> region(window.track_count(), -1);
  if (std::ssize(tracks) < kLeastInRegion * kRegions) return region;
  sort(tracks.begin(), tracks.end(), 0);
  const auto part = [&](int k) { return tracks.begin() + std::ssize(tracks) * k / kSide; };
  for (int column = 0; column < kSide; ++column) {
    const auto begin = part(column), end = part(column + 1);
    sort(begin, end, 1);
    for (auto track = begin; track != end; ++track)
      region[*track] = kSide * column + static_cast<int>(kSide * (track - begin) / (end - begin));
  }
  return region;
}

template <class T>
std::vector<T> picked(const std::vector<T>& values, const std::vector<int>& indices) {
  std::vector<T> all;
  for (const int j : indices) all.push_back(values[j]);
  return all;
}

/// Returns a covariance from the estimates without each region, one per column.
template <int size>
Eigen::Matrix<double, size, size> spread_of_columns(const Eigen::Matrix<double, size, -1>& x) {
  const Eigen::Matrix<double, size, -1> off = x.colwise() - x.rowwise().mean();
  return (kRegions - 1.0) / static_cast<double>(x.cols()) * off * off.transpose();
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

/// Returns the variances of the centers by the regions relative to the analytic ones.
double ratio_of_centers(const NoiseSpread& by_regions, const NoiseSpread& analytic) {
  double of_regions = 0, of_analytic = 0;
  for (std::size_t i = 1; i < analytic.centers.size(); ++i) {
    of_regions += by_regions.centers[i].trace();
    of_analytic += analytic.centers[i].trace();
  }
  return of_analytic > 0 ? of_regions / of_analytic : 1;
}

void widen_centers(double ratio, Uncertainty& u) {
  for (std::size_t i = 1; i < u.center_covariances.size(); ++i) {
    u.center_covariances[i] += (ratio - 1) * u.noise.centers[i];
    const Index at = 3 * (static_cast<Index>(i) - 1);
    if (!u.own && u.joint_covariance.rows() > 0)
      reshape(u.joint_covariance, at, u.center_covariances[i]);
    if (u.pose_covariance.rows() > 0)
      reshape(u.pose_covariance, 2 * at + 3, u.center_covariances[i]);
    double& sigma = u.distance_ratio_sigmas[i];
    sigma = std::sqrt(std::max(0.0, sigma * sigma + (ratio - 1) * u.noise.distance_ratios[i]));
    u.noise.centers[i] *= ratio;
    u.noise.distance_ratios[i] *= ratio;
  }
}

/// Returns a variance that the tracks' noise determines, `ratio` times as large up to the prior's.
double widened(double variance, double prior_variance, double ratio) {
  const double information = 1 / variance / ratio + (1 - 1 / ratio) / prior_variance;
  return 1 / std::max(information, 1 / prior_variance);
}

/// Widens the covariances of further planes, bias, clock, row delay and the rotations of the poses.
void widen_others(double ratio, const Window& window, Uncertainty& u) {
  if (!(ratio > 1)) return;
  for (PlaneUncertainty& other : u.others) {
    other.normal_covariance *= ratio;
    other.log_distance_sigma *= std::sqrt(ratio);
  }
  double of_rotations = u.rotations == RotationModel::free ? ratio : 1;
  if (u.bias_covariance && window.gyro) {
    const GyroVector priors = gyro_prior_sigmas(window, 4);
    const double before = u.bias_covariance->trace();
    const double after = widened(before, 3 * priors(0) * priors(0), ratio);
    *u.bias_covariance *= after / before;
    if (u.time_offset_sigma_s)
      *u.time_offset_sigma_s =
          std::sqrt(widened(std::pow(*u.time_offset_sigma_s, 2), priors(3) * priors(3), ratio));
    of_rotations = after / before;
  }
  if (u.row_delay_sigma_s) {
    const double prior_s = window.row_delay.value_or(unknown_row_delay(window)).sigma_s;
    if (*u.row_delay_sigma_s > 0 && prior_s > 0)
      *u.row_delay_sigma_s =
          std::sqrt(widened(std::pow(*u.row_delay_sigma_s, 2), prior_s * prior_s, ratio));
  }
  for (Index at = 0; at < u.pose_covariance.rows(); at += 6) {
    const Matrix3d rotation = of_rotations * u.pose_covariance.block<3, 3>(at, at);
    reshape(u.pose_covariance, at, rotation);
  }
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

std::optional<NoiseSpread> spread_by_regions(
    const Window& window,
    const Initialization& result,
    const std::function<Initialization(const Window& without_region)>& initialize) {
  const std::vector<int> region = regions_of(window);
  if (std::ranges::max(region) < 0) return std::nullopt;
  std::vector<Initialization> runs(kRegions);
  in_parallel(kRegions, static_cast<int>(std::thread::hardware_concurrency()), [&](int g) {
    std::vector<bool> removed(region.size());
    for (std::size_t j = 0; j < region.size(); ++j) removed[j] = region[j] == g;
    runs[g] = initialize(without_tracks(window, removed));
  });
  if (std::ranges::any_of(runs, &Initialization::stopped)) return std::nullopt;
  std::erase_if(runs, [&](const Initialization& run) {
    return !run.ok || angle_deg(run.plane.normal, result.plane.normal) > kOtherMinimum_deg;
  });
  const Index solved = std::ssize(runs);
  if (2 * solved <= kRegions) return NoiseSpread{.unstable = true};
  const auto tangents = normal_tangents(result.plane.normal);
  Eigen::Matrix2Xd normals(2, solved);
  for (Index k = 0; k < solved; ++k) normals.col(k) = tangents.transpose() * runs[k].plane.normal;
  NoiseSpread spread{.normal = spread_of_columns<2>(normals)};
  Eigen::Matrix3Xd centers(3, solved);
  Eigen::RowVectorXd ratios(solved);
  for (int i = 0; i < window.frame_count(); ++i) {
    for (Index k = 0; k < solved; ++k) {
      const Plane& plane = runs[k].plane;
      centers.col(k) = runs[k].cameras[i].p_wc / plane.distance;
      ratios(k) = 1 + plane.normal.dot(centers.col(k));
    }
    spread.centers.push_back(spread_of_columns<3>(centers));
    spread.distance_ratios.push_back(spread_of_columns<1>(ratios)(0));
  }
  return spread;
}

Uncertainty with_size(Uncertainty u,
                      const Window& window,
                      const Plane& plane,
                      const std::optional<NoiseSpread>& by_regions) {
  const double analytic = u.noise.normal.trace();
  if (!(analytic > 0)) return u;
  const double of_regions = by_regions ? by_regions->normal.trace() : 0;
  const double of_bend = std::pow(radians(u.bend_sigma_deg.value_or(0)), 2);
  const double size = std::max({analytic, of_regions, of_bend});
  u.bend_sigma_deg.reset();
  u.neighbors_sigma_deg.reset();
  if (of_bend > of_regions ? of_bend > analytic : of_regions > kDisagreement * analytic)
    (of_bend > of_regions ? u.bend_sigma_deg : u.neighbors_sigma_deg) =
        degrees(std::sqrt(size - analytic));
  Matrix2d shape = u.noise.normal / analytic;
  if (of_regions > 0)
    shape = kAnalyticShare * shape + (1 - kAnalyticShare) / of_regions * by_regions->normal;
  const auto N = normal_tangents(plane.normal);
  const Matrix2d others = N.transpose() * u.normal_covariance * N - u.noise.normal;
  const Matrix2d normal = size * shape + power_of_positive(others, 1);
  const double ratio = size / analytic;
  widen_centers(by_regions ? std::max(ratio, ratio_of_centers(*by_regions, u.noise)) : ratio, u);
  widen_others(ratio, window, u);
  if (!u.own && u.joint_covariance.rows() > 0) {
    const Index planes_at = 3 * (std::ssize(u.center_covariances) - 1) + u.joint_bias_rows;
    reshape(u.joint_covariance, planes_at, normal);
  }
  set_normal_covariance(N * normal * N.transpose(), u);
  u.noise.normal = size * shape;
  u.own = u.own || by_regions;
  u.has_size = true;
  return u;
}

}  // namespace gpo
