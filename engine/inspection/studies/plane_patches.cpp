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

/// Single tracks far away, near the plane's horizon, are not its extent.
constexpr double kFarthest = 3;  // median distances from the camera

std::vector<MapPoint> points_on(const Inspection& inspection, const PlaneEstimate& estimate) {
  const Window& window = *inspection.window;
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  std::vector<MapPoint> points;
  for (const int j : window.planes[estimate.number].tracks) {
    const Vector3d ray = K_inverse * window.points_px[0].col(j).homogeneous();
    if (const auto point = intersect(estimate.plane, Pose{}, ray)) points.push_back({j, *point});
  }
  if (points.empty()) return points;
  std::vector<double> distances;
  for (const MapPoint& point : points) distances.push_back(point.position.norm());
  const double most = kFarthest * median(std::move(distances));
  std::erase_if(points, [&](const MapPoint& point) { return point.position.norm() > most; });
  return points;
}

}  // namespace

std::vector<PlanePatch> plane_patches(const Inspection& inspection) {
  std::vector<PlanePatch> patches;
  for (const PlaneEstimate& estimate : inspection.initialization->planes) {
    if (estimate.number == inspection.window->leader) continue;
    PlanePatch patch{estimate.number, estimate.plane.normal, {}, points_on(inspection, estimate)};
    if (patch.points.size() < 3) continue;
    // Along the picture's rows as far as the plane allows.
    Vector3d x = Vector3d::UnitX() - patch.normal.x() * patch.normal;
    if (x.norm() < 0.1) x = patch.normal.unitOrthogonal();
    x.normalize();
    const Vector3d y = patch.normal.cross(x);
    Eigen::AlignedBox2d box;
    for (const MapPoint& p : patch.points)
      box.extend(Eigen::Vector2d(x.dot(p.position), y.dot(p.position)));
    const Vector3d foot = -estimate.plane.distance * patch.normal;
    const auto at = [&](double u, double v) -> Vector3d { return foot + u * x + v * y; };
    patch.corners = {at(box.min().x(), box.min().y()),
                     at(box.max().x(), box.min().y()),
                     at(box.max().x(), box.max().y()),
                     at(box.min().x(), box.max().y())};
    patches.push_back(std::move(patch));
  }
  return patches;
}

}  // namespace gpo
