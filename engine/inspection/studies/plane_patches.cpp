// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/plane_patches.h"

#include "engine/geometry/statistics.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Vector3d;

constexpr double kFarthest =
    3;  // limit of the extent, in median distances: excludes points near the horizon

std::vector<MapPoint> points_on(const Window& window,
                                const std::vector<int>& tracks,
                                const Plane& plane) {
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  std::vector<MapPoint> points;
  for (const int j : tracks) {
    const Vector3d ray = K_inverse * window.points_px[0].col(j).homogeneous();
    if (const auto point = intersect(plane, Pose{}, ray)) points.push_back({j, *point});
  }
  if (points.empty()) return points;
  std::vector<double> distances;
  for (const MapPoint& point : points) distances.push_back(point.position.norm());
  const double most = kFarthest * median(std::move(distances));
  std::erase_if(points, [&](const MapPoint& point) { return point.position.norm() > most; });
  return points;
}

std::optional<PlanePatch> patch_of(const Window& window,
                                   int number,
                                   const std::vector<int>& tracks,
                                   const Plane& plane) {
  PlanePatch patch{.number = number,
                   .normal = plane.normal,
                   .corners = {},
                   .points = points_on(window, tracks, plane)};
  if (patch.points.size() < 3) return std::nullopt;
  // The axis x is as near as possible to the image rows.
  Vector3d x = Vector3d::UnitX() - patch.normal.x() * patch.normal;
  if (x.norm() < 0.1) x = patch.normal.unitOrthogonal();
  x.normalize();
  const Vector3d y = patch.normal.cross(x);
  Eigen::AlignedBox2d box;
  for (const MapPoint& p : patch.points)
    box.extend(Eigen::Vector2d(x.dot(p.position), y.dot(p.position)));
  const Vector3d foot = -plane.distance * patch.normal;
  const auto at = [&](double u, double v) -> Vector3d { return foot + u * x + v * y; };
  patch.corners = {at(box.min().x(), box.min().y()),
                   at(box.max().x(), box.min().y()),
                   at(box.max().x(), box.max().y()),
                   at(box.min().x(), box.max().y())};
  return patch;
}

}  // namespace

std::vector<PlanePatch> plane_patches(const Inspection& inspection) {
  const Window& window = *inspection.window;
  std::vector<PlanePatch> patches;
  for (const PlaneEstimate& estimate : inspection.initialization->planes) {
    const int number = estimate.number;
    if (number == window.leader) continue;
    auto patch = patch_of(window, number, window.planes[number].tracks, estimate.plane);
    if (patch) patches.push_back(std::move(*patch));
  }
  return patches;
}

std::optional<PlanePatch> refused_patch(const Inspection& inspection) {
  const auto& refused = inspection.initialization->refused;
  if (!refused) return std::nullopt;
  const Window& window = *inspection.window;
  return patch_of(window, window.leader, window.inlier_tracks(0), refused->plane);
}

}  // namespace gpo
