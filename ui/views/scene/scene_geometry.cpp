// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/scene/scene_geometry.h"

#include "engine/truth/truth.h"
#include "ui/views/scene/uncertainty_geometry.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace gpo {
namespace {

using Eigen::Vector3d;

constexpr double kCellsAcross = 12;  // of the plane's grid, about

Similarity inverted(const Similarity& T) {
  const Eigen::Matrix3d R = T.R_ab.transpose();
  return {1 / T.scale, R, R * (-T.t_ab / T.scale)};
}

/// The true plane's distance from the true reference camera [m].
std::optional<double> true_distance(const WindowTruth& truth) {
  if (!truth.plane || !truth.cameras.front()) return std::nullopt;
  return std::abs(plane_in_camera(*truth.plane, *truth.cameras.front()).distance);
}

Pose moved(const Similarity& T, const Pose& pose) { return {T.R_ab * pose.R_wc, T * pose.p_wc}; }

/// Values at both ends without the outermost percents, which single wrong points own.
std::array<double, 2> usual_range(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t cut = values.size() / 25;
  return {values[cut], values[values.size() - 1 - cut]};
}

/// The grid's axes and origin; its extent is still empty.
PlaneGrid grid_axes(const Inspection& inspection) {
  const Plane& plane = inspection.initialization->plane;
  PlaneGrid grid;
  grid.normal = plane.normal;
  const Vector3d along =
      inspection.cube ? Vector3d(inspection.cube->axes.col(0)) : Vector3d::UnitX();
  grid.x = (along - grid.normal * grid.normal.dot(along)).normalized();
  grid.y = grid.normal.cross(grid.x);
  grid.origin =
      inspection.cube ? inspection.cube->origin : Vector3d(-plane.distance * plane.normal);
  return grid;
}

void add_frusta(const Inspection& inspection, std::vector<Vector3d>& extent) {
  const double depth = frustum_depth(inspection);
  const auto add = [&](const Pose& pose) {
    for (const Vector3d& corner : frustum(inspection.recording->camera, pose, depth))
      extent.push_back(corner);
  };
  for (const Pose& pose : inspection.initialization->cameras) add(pose);
  const auto T_est_true = estimate_from_truth(inspection);
  if (!T_est_true) return;
  for (int i = 0; i < static_cast<int>(inspection.truth->cameras.size()); ++i)
    if (const auto pose = true_camera(inspection, *T_est_true, i)) add(*pose);
}

}  // namespace

double nice_length(double length) {
  const double power = std::pow(10, std::floor(std::log10(length)));
  for (const double step : {5, 2})
    if (step * power <= length * (1 + 1e-12)) return step * power;
  return power;
}

std::optional<Similarity> estimate_from_truth(const Inspection& inspection) {
  if (!inspection.truth) return std::nullopt;
  const WindowTruth& truth = *inspection.truth;
  const auto& evaluation = inspection.evaluation;
  if (evaluation && evaluation->alignment == Alignment::ok && evaluation->T_true_est)
    return inverted(*evaluation->T_true_est);
  if (!truth.cameras.front()) return std::nullopt;
  const double estimated =
      inspection.initialization->ok ? inspection.initialization->plane.distance : 1;
  std::optional<double> meters_a_unit = evaluation ? evaluation->scale : std::nullopt;
  if (const auto distance = true_distance(truth); !meters_a_unit && distance)
    meters_a_unit = *distance / estimated;
  if (!meters_a_unit || !(*meters_a_unit > 0)) return std::nullopt;
  const Pose& reference = *truth.cameras.front();
  return inverted({*meters_a_unit, reference.R_wc, reference.p_wc});
}

std::optional<Pose> true_camera(const Inspection& inspection,
                                const Similarity& T_est_true,
                                int frame_in_window) {
  const auto& pose = inspection.truth->cameras[frame_in_window];
  return pose ? std::optional(moved(T_est_true, *pose)) : std::nullopt;
}

std::array<Vector3d, 6> frustum(const Camera& camera, const Pose& pose, double depth) {
  const auto corner = [&](double u, double v) -> Vector3d {
    const Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
    return to_world(pose, depth * ray);
  };
  const double right = camera.width - 0.5, bottom = camera.height - 0.5;
  return {pose.p_wc,
          corner(-0.5, -0.5),
          corner(right, -0.5),
          corner(right, bottom),
          corner(-0.5, bottom),
          corner((right - 0.5) / 2, -0.5 - 0.28 * camera.height)};
}

double frustum_depth(const Inspection& inspection) {
  const Initialization& estimate = *inspection.initialization;
  if (!estimate.ok) return 0.08;
  Vector3d low = Vector3d::Zero(), high = Vector3d::Zero();
  for (const Pose& pose : estimate.cameras) {
    low = low.cwiseMin(pose.p_wc);
    high = high.cwiseMax(pose.p_wc);
  }
  return std::clamp(
      0.3 * (high - low).norm(), 0.09 * estimate.plane.distance, 0.14 * estimate.plane.distance);
}

double axes_length(const Inspection& inspection) { return 1.6 * frustum_depth(inspection); }

int frustum_stride(const Inspection& inspection) {
  return std::max(1, (inspection.window->frame_count() + 5) / 10);
}

PlaneGrid plane_grid(const Inspection& inspection, double cube_side) {
  PlaneGrid grid = grid_axes(inspection);
  std::vector<double> xs, ys;
  const auto add = [&](const Vector3d& point) {
    xs.push_back(grid.x.dot(point - grid.origin));
    ys.push_back(grid.y.dot(point - grid.origin));
  };
  for (const MapPoint& point : inspection.initialization->points) add(point.position);
  if (xs.empty()) add(grid.origin);
  std::array<double, 2> x = usual_range(xs), y = usual_range(ys);
  if (inspection.cube)
    for (const Vector3d& corner : cube_corners(*inspection.cube, cube_side)) {
      const double cx = grid.x.dot(corner - grid.origin), cy = grid.y.dot(corner - grid.origin);
      x = {std::min(x[0], cx), std::max(x[1], cx)};
      y = {std::min(y[0], cy), std::max(y[1], cy)};
    }
  const double least = 0.5 * inspection.initialization->plane.distance;
  grid.cell = nice_length(std::max({x[1] - x[0], y[1] - y[0], least}) / kCellsAcross * 1.5);
  const auto below = [&](double value) { return static_cast<int>(std::floor(value / grid.cell)); };
  grid.low = {below(x[0]), below(y[0])};
  grid.high = {below(x[1]) + 1, below(y[1]) + 1};
  return grid;
}

std::optional<std::array<Vector3d, 4>> true_plane_border(const Inspection& inspection,
                                                         const Similarity& T_est_true,
                                                         const PlaneGrid& grid) {
  if (!inspection.truth->plane) return std::nullopt;
  const Plane& plane = *inspection.truth->plane;
  const Vector3d normal = T_est_true.R_ab * plane.normal;
  const Vector3d on_plane = T_est_true * Vector3d(-plane.distance * plane.normal);
  const double slope = normal.dot(grid.normal);
  if (std::abs(slope) < 0.1) return std::nullopt;
  std::array<Vector3d, 4> border;
  const double i0 = grid.low[0] - 0.5, i1 = grid.high[0] + 0.5;
  const double j0 = grid.low[1] - 0.5, j1 = grid.high[1] + 0.5;
  const std::array<Vector3d, 4> corners = {
      grid.at(i0, j0), grid.at(i1, j0), grid.at(i1, j1), grid.at(i0, j1)};
  for (int k = 0; k < 4; ++k) {
    border[k] = corners[k] - grid.normal * (normal.dot(corners[k] - on_plane) / slope);
  }
  return border;
}

std::vector<Vector3d> scene_extent(const Inspection& inspection, double cube_side) {
  std::vector<Vector3d> extent;
  add_frusta(inspection, extent);
  for (int axis = 0; axis < 3; ++axis)
    extent.push_back(axes_length(inspection) * Vector3d::Unit(axis));
  if (!inspection.initialization->ok) return extent;
  const PlaneGrid grid = plane_grid(inspection, cube_side);
  for (const int i : {grid.low[0], grid.high[0]})
    for (const int j : {grid.low[1], grid.high[1]}) extent.push_back(grid.at(i, j));
  if (inspection.initialization->uncertainty) extent.push_back(normal_arrow(inspection, grid).tip);
  if (const auto T_est_true = estimate_from_truth(inspection))
    if (const auto border = true_plane_border(inspection, *T_est_true, grid))
      extent.insert(extent.end(), border->begin(), border->end());
  if (inspection.cube)
    for (const Vector3d& corner : cube_corners(*inspection.cube, cube_side))
      extent.push_back(corner);
  return extent;
}

OrbitCamera default_scene_camera(const Inspection& inspection, double cube_side, double aspect) {
  OrbitCamera camera;
  camera.up = inspection.initialization->ok ? inspection.initialization->plane.normal
                                            : Vector3d(-Vector3d::UnitY());
  // Forward along the plane as the reference camera sees it; where it looks straight down, up.
  Vector3d ahead = Vector3d::UnitZ() - camera.up * camera.up.z();
  if (ahead.norm() < 0.2) ahead = -Vector3d::UnitY() + camera.up * camera.up.y();
  camera.front = ahead.normalized();
  camera.yaw_deg = 35;
  // A plane seen at a slant is wide and low: the taller the view, the steeper it is looked upon.
  camera.pitch_deg = std::clamp(42 - 13 * aspect, 25.0, 32.0);
  return fitted(camera, scene_extent(inspection, cube_side), aspect, {.bottom = 0.24});
}

}  // namespace gpo
