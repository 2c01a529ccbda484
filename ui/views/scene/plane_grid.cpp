// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/scene/plane_grid.h"

#include "engine/inspection/plane_names.h"
#include "engine/truth/truth.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

namespace gpo {
namespace {

using Eigen::Vector3d;

constexpr double kCellsAcross = 12;  // of the plane's grid, about

/// Values at both ends without the outermost percents, which single wrong points own.
std::array<double, 2> usual_range(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t cut = values.size() / 25;
  return {values[cut], values[values.size() - 1 - cut]};
}

/// Of the grid's unit: by the truth, else by the accelerometer, else the plane's distance.
double grid_unit_m(const Inspection& inspection) {
  if (inspection.evaluation && inspection.evaluation->scale) return *inspection.evaluation->scale;
  return known_scale(inspection).value_or(1);
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

}  // namespace

double nice_length(double length) {
  const double power = std::pow(10, std::floor(std::log10(length)));
  for (const double step : {5, 2})
    if (step * power <= length * (1 + 1e-12)) return step * power;
  return power;
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
  const double unit = grid_unit_m(inspection);
  grid.cell =
      nice_length(unit * std::max({x[1] - x[0], y[1] - y[0], least}) / kCellsAcross * 1.5) / unit;
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

}  // namespace gpo
