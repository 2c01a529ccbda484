// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/bundle/bundle_adjustment.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/initializers.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Plausible inverse depths of a start [1/d]; other tracks start on the plane, or far away.
constexpr double kLeastInverseDepth = 0.05;
constexpr double kMostInverseDepth = 20;

bool used(const Window& window, int frame, int track) {
  return window.all_tracks ? window.points_px[frame].col(track).allFinite()
                           : window.inlier[frame][track];
}

/// Solves x_i x R_ciw (x_1 - rho p_wci) = 0 for rho by least squares over the track's observations.
double triangulated_inverse_depth(const Window& window,
                                  std::span<const Pose> cameras,
                                  const Matrix3d& K_inverse,
                                  int track) {
  const Vector3d ray_1 = K_inverse * window.points_px[0].col(track).homogeneous();
  double numerator = 0;
  double denominator = 0;
  for (int i = 1; i < window.frame_count(); ++i) {
    if (!used(window, i, track)) continue;
    const Vector3d x = K_inverse * window.points_px[i].col(track).homogeneous();
    const Matrix3d R_cw = cameras[i].R_wc.transpose();
    const Vector3d b = x.cross(R_cw * cameras[i].p_wc);
    numerator += b.dot(x.cross(R_cw * ray_1));
    denominator += b.squaredNorm();
  }
  return numerator / denominator;
}

/// Takes the start's points; triangulates other tracks, or puts them on its plane if that fails.
Bundle start_bundle(const Window& window, const Initialization& start) {
  const Matrix3d K_inverse = window.K.inverse();
  Bundle bundle{start.cameras, Eigen::Matrix3Xd(3, window.track_count())};
  for (int j = 0; j < window.track_count(); ++j) {
    const Vector3d ray_1 = K_inverse * window.points_px[0].col(j).homogeneous();
    const double rho = triangulated_inverse_depth(window, start.cameras, K_inverse, j);
    const bool plausible = rho > kLeastInverseDepth && rho < kMostInverseDepth;
    const double rho_plane = std::max(-start.plane.normal.dot(ray_1), kLeastInverseDepth);
    bundle.points.col(j) << window.points_px[0].col(j), plausible ? rho : rho_plane;
  }
  for (const MapPoint& point : start.points) {
    if (point.position.z() > 0) bundle.points(2, point.track) = 1 / point.position.z();
  }
  return bundle;
}

std::optional<std::string> reason_of_too_few(const Window& window,
                                             std::span<const Observation> kept) {
  std::vector<int> count(window.frame_count(), 0);
  for (const Observation& observation : kept) ++count[observation.frame];
  for (int i = 0; i < window.frame_count(); ++i) {
    if (count[i] < kLeastInliers) {
      return fmt::format("too few tracks agree: frame {} has {} left, at least {} are needed",
                         window.start + i,
                         count[i],
                         kLeastInliers);
    }
  }
  return std::nullopt;
}

/// Returns the points of the remaining tracks in front of the camera, in the bundle's scale.
std::vector<MapPoint> map_points(const Window& window, const AdjustedBundle& adjusted) {
  std::vector<bool> kept(window.track_count(), false);
  for (const Observation& observation : adjusted.kept) kept[observation.point] = true;
  std::vector<MapPoint> points;
  for (int j = 0; j < window.track_count(); ++j) {
    const Vector3d point = adjusted.bundle.points.col(j);
    if (kept[j] && point.z() > 0) points.push_back({j, position(window.K, point)});
  }
  return points;
}

std::optional<Plane> plane_of_inliers(const Window& window, std::span<const MapPoint> points) {
  Eigen::Matrix3Xd positions(3, 0);
  for (const MapPoint& point : points) {
    if (!window.is_inlier_track(point.track)) continue;
    positions.conservativeResize(3, positions.cols() + 1);
    positions.rightCols<1>() = point.position;
  }
  return fit_plane(positions);
}

/// World = reference camera, plane distance 1.
Initialization result_of_bundle(const Window& window, const AdjustedBundle& adjusted) {
  std::vector<MapPoint> points = map_points(window, adjusted);
  const std::optional<Plane> plane = plane_of_inliers(window, points);
  if (!plane) return failed("the adjusted inlier points determine no plane", adjusted.solver);
  Initialization result;
  result.plane = {plane->normal, 1};
  result.cameras = adjusted.bundle.cameras;
  for (Pose& camera : result.cameras) camera.p_wc /= plane->distance;
  for (MapPoint& point : points) point.position /= plane->distance;
  result.points = std::move(points);
  result.solver = adjusted.solver;
  result.rms_px =
      std::sqrt(2 * adjusted.solver.final_cost / static_cast<double>(adjusted.kept.size()));
  return result;
}

Initialization result_on_plane(const Window& window, const AdjustedBundle& adjusted) {
  Initialization result;
  result.plane = {adjusted.bundle.normal, 1};
  result.cameras = adjusted.bundle.cameras;
  for (int j = 0; j < window.track_count(); ++j) {
    if (window.is_inlier_track(j))
      result.points.push_back({j, position(window.K, adjusted.bundle.points.col(j))});
  }
  result.solver = adjusted.solver;
  // An observation has two residuals.
  result.rms_px = std::sqrt(4 * adjusted.solver.final_cost / adjusted.solver.residuals);
  return result;
}

}  // namespace

Initialization refine_bundle(const Window& window,
                             const Initialization& start,
                             const Watch& watch) {
  const auto is_used = [&](int frame, int track) { return used(window, frame, track); };
  const AdjustedBundle adjusted = adjust_bundle_robustly(window.K,
                                                         start_bundle(window, start),
                                                         track_observations(window, is_used),
                                                         homography_error_px(window),
                                                         watch);
  const SolverReport& solver = adjusted.solver;
  if (auto reason = reason_of_too_few(window, adjusted.kept)) return failed(*reason, solver);
  if (solver.termination != Termination::convergence) return not_converged(solver);
  Initialization result = result_of_bundle(window, adjusted);
  if (result.cameras.empty()) return result;
  return trusted(window, std::move(result));
}

template <PlaneNormal normal>
Initialization refine_on_plane(const Window& window,
                               const Initialization& start,
                               const Watch& watch) {
  const auto is_inlier = [&](int frame, int track) { return bool{window.inlier[frame][track]}; };
  const AdjustedBundle adjusted = adjust_bundle(
      window.K,
      bundle_on_plane(window.K, start.cameras, start.plane.normal, window.points_px[0]),
      track_observations(window, is_inlier),
      {.normal = normal},
      watch);
  if (adjusted.solver.termination != Termination::convergence)
    return not_converged(adjusted.solver);
  return trusted(window, result_on_plane(window, adjusted));
}

template Initialization refine_on_plane<PlaneNormal::free>(const Window&,
                                                           const Initialization&,
                                                           const Watch&);
template Initialization refine_on_plane<PlaneNormal::held>(const Window&,
                                                           const Initialization&,
                                                           const Watch&);

}  // namespace gpo
