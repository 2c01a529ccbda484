// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"
#include "engine/inspection/studies/studies.h"
#include "engine/methods/plane/normal_landscape.h"
#include "engine/truth/truth.h"
#include "ui/views/scene/scene_view.h"

#include <algorithm>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Line = std::vector<Vector3d>;

Similarity inverted(const Similarity& T) {
  const Matrix3d R = T.R_ab.transpose();
  return {1 / T.scale, R, R * (-T.t_ab / T.scale)};
}

/// Returns the true plane's distance from the true reference camera [m].
std::optional<double> true_distance(const WindowTruth& truth) {
  if (!truth.plane || !truth.cameras.front()) return std::nullopt;
  return std::abs(plane_in_camera(*truth.plane, *truth.cameras.front()).distance);
}

void add_frusta(const Inspection& inspection, Line& extent) {
  const double depth = frustum_depth(inspection);
  const auto add = [&](const Pose& pose) {
    std::ranges::copy(frustum(inspection.recording->camera, pose, depth),
                      std::back_inserter(extent));
  };
  std::ranges::for_each(found_cameras(*inspection.initialization), add);
  for (const auto& [frame, pose] : true_cameras(inspection)) add(pose);
}

/// Returns the semi-axes of x' C^-1 x = chi_square as columns, the longest last.
Matrix3d semi_axes(const Matrix3d& covariance, double chi_square) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(covariance);
  const Vector3d lengths = (chi_square * eigen.eigenvalues().cwiseMax(0)).cwiseSqrt();
  return eigen.eigenvectors() * lengths.asDiagonal();
}

Line ellipse(const Vector3d& a, const Vector3d& b, int sides) {
  Line line;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    line.emplace_back(std::cos(angle) * a + std::sin(angle) * b);
  }
  return line;
}

/// Rotates a unit normal towards the perpendicular `turn` [rad], by at most a right angle.
Vector3d tilted(const Vector3d& normal, const Vector3d& turn) {
  const double angle = std::min(turn.norm(), std::numbers::pi / 2);
  if (angle < 1e-12) return normal;
  return std::cos(angle) * normal + std::sin(angle) * turn.normalized();
}

/// Returns the normals on the disc that are rotated by an ellipse with semi-axes a and b [rad].
std::vector<Vector2d> ellipse_on_disc(const Vector3d& normal,
                                      const Vector3d& a,
                                      const Vector3d& b) {
  std::vector<Vector2d> line;
  for (const Vector3d& turn : ellipse(a, b, 72))
    line.push_back(disc_from_normal(tilted(normal, turn)));
  return line;
}

/// The leading plane is the ground unless gravity contradicts; then up is opposite to gravity.
Vector3d up_of(const Inspection& inspection) {
  const auto name = plane_name(inspection, inspection.window->leader);
  const bool ground = !name || name->name == "floor" || name->name == "table";
  return ground ? inspection.initialization->plane.normal
                : Vector3d(-inspection.inertial->gravity_m_s2.normalized());
}

OrbitCamera fitted_to_all(const OrbitCamera& camera,
                          const Inspection& inspection,
                          double cube_side,
                          double aspect) {
  Line extent = scene_extent(inspection, cube_side);
  for (const PlanePatch& patch : plane_patches(inspection))
    extent.insert(extent.end(), patch.corners.begin(), patch.corners.end());
  return fitted(camera, extent, aspect, {.bottom = 0.24});
}

/// Views the scene through a camera of the window, high enough to show its whole image, whose
/// principal point is in the middle of the view.
OrbitCamera through_camera(const Inspection& inspection, double aspect, int frame) {
  const auto& cameras = inspection.initialization->cameras;
  const int last = static_cast<int>(cameras.size()) - 1;
  const Pose& pose = cameras[std::clamp(frame - inspection.window->start, 0, last)];
  const Camera& lens = inspection.recording->camera;
  const auto half_tangent = [](double center_px, int size, double focal_px) {
    return std::max(center_px + 0.5, size - 0.5 - center_px) / focal_px;
  };
  Vector2d half(half_tangent(lens.cx, lens.width, lens.fx),
                half_tangent(lens.cy, lens.height, lens.fy));
  Vector3d up_c(0, -1, 0);
  for (int turn = 0; turn < inspection.recording->quarter_turns; ++turn) {
    half = half.reverse().eval();
    up_c = Vector3d(up_c.y(), -up_c.x(), 0);
  }
  const double half_height = std::max(half.y(), half.x() / aspect);
  OrbitCamera camera;
  camera.up = pose.R_wc * up_c;
  camera.front = pose.R_wc.col(2);
  camera.pitch_deg = 0;
  camera.distance = plane_in_camera(inspection.initialization->plane, pose).distance;
  camera.target = pose.p_wc + camera.distance * camera.front;
  camera.view_angle_deg = 2 * std::atan(half_height) * 180 / std::numbers::pi;
  return camera;
}

}  // namespace

const std::vector<Pose>& found_cameras(const Initialization& estimate) {
  return estimate.refused ? estimate.refused->cameras : estimate.cameras;
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
  std::optional<double> scale = evaluation ? evaluation->scale : std::nullopt;
  if (const auto distance = true_distance(truth); !scale && distance) scale = *distance / estimated;
  if (!scale || !(*scale > 0)) return std::nullopt;
  const Pose& reference = *truth.cameras.front();
  return inverted({*scale, reference.R_wc, reference.p_wc});
}

std::map<int, Pose> true_cameras(const Inspection& inspection) {
  std::map<int, Pose> cameras;
  const auto T = estimate_from_truth(inspection);
  for (int i = 0; T && i < std::ssize(inspection.truth->cameras); ++i)
    if (const auto& pose = inspection.truth->cameras[i])
      cameras[i] = {T->R_ab * pose->R_wc, *T * pose->p_wc};
  return cameras;
}

Frustum frustum(const Camera& camera, const Pose& pose, double depth) {
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
  const std::vector<Pose>& cameras = found_cameras(estimate);
  if (cameras.empty()) return 0.08;
  const double distance = estimate.ok ? estimate.plane.distance : estimate.refused->plane.distance;
  Eigen::AlignedBox3d box(Vector3d::Zero().eval());
  for (const Pose& pose : cameras) box.extend(pose.p_wc);
  return std::clamp(0.3 * box.diagonal().norm(), 0.09 * distance, 0.14 * distance);
}

double axes_length(const Inspection& inspection) { return 1.6 * frustum_depth(inspection); }

int frustum_stride(const Inspection& inspection) {
  return std::max(1, (inspection.window->frame_count() + 5) / 10);
}

double nice_length(double length) {
  const double power = std::pow(10, std::floor(std::log10(length)));
  for (const double step : {5, 2})
    if (step * power <= length * (1 + 1e-12)) return step * power;
  return power;
}

std::array<Vector3d, 4> PlaneGrid::corners(double margin) const {
  const double i0 = low[0] - margin, i1 = high[0] + margin;
  const double j0 = low[1] - margin, j1 = high[1] + margin;
  return {at(i0, j0), at(i1, j0), at(i1, j1), at(i0, j1)};
}

PlaneGrid plane_grid(const Inspection& inspection, double cube_side) {
  const Plane& plane = inspection.initialization->plane;
  const auto& cube = inspection.cube;
  PlaneGrid grid;
  grid.normal = plane.normal;
  const Vector3d along = cube ? Vector3d(cube->axes.col(0)) : Vector3d::UnitX();
  grid.x = (along - grid.normal * grid.normal.dot(along)).normalized();
  grid.y = grid.normal.cross(grid.x);
  grid.origin = cube ? cube->origin : Vector3d(-plane.distance * plane.normal);
  std::vector<double> xs, ys;
  const auto add = [&](const Vector3d& point) {
    xs.push_back(grid.x.dot(point - grid.origin));
    ys.push_back(grid.y.dot(point - grid.origin));
  };
  for (const MapPoint& point : inspection.initialization->points) add(point.position);
  if (xs.empty()) add(grid.origin);
  std::array<double, 2> x = middle_range(xs), y = middle_range(ys);
  if (cube)
    for (const Vector3d& corner : cube_corners(*cube, cube_side)) {
      const double cx = grid.x.dot(corner - grid.origin), cy = grid.y.dot(corner - grid.origin);
      x = {std::min(x[0], cx), std::max(x[1], cx)};
      y = {std::min(y[0], cy), std::max(y[1], cy)};
    }
  constexpr double kCellsAcross = 8;  // about
  const double unit = shown_scale(inspection).value_or(1);
  const double size = std::max({x[1] - x[0], y[1] - y[0], 0.5 * plane.distance});
  grid.cell = nice_length(unit * size / kCellsAcross) / unit;
  const auto below = [&](double value) { return static_cast<int>(std::floor(value / grid.cell)); };
  grid.low = {below(x[0]), below(y[0])};
  grid.high = {below(x[1]) + 1, below(y[1]) + 1};
  return grid;
}

std::optional<double> shown_scale(const Inspection& inspection) {
  if (inspection.measured_scale && known_scale(inspection)) return known_scale(inspection);
  if (inspection.evaluation && inspection.evaluation->scale) return inspection.evaluation->scale;
  if (const auto T_est_true = estimate_from_truth(inspection)) return 1 / T_est_true->scale;
  return known_scale(inspection);
}

std::optional<std::array<Vector3d, 4>> true_plane_border(const Inspection& inspection,
                                                         const PlaneGrid& grid) {
  const auto T_est_true = estimate_from_truth(inspection);
  if (!T_est_true || !inspection.truth->plane) return std::nullopt;
  const Plane& plane = *inspection.truth->plane;
  const Vector3d normal = T_est_true->R_ab * plane.normal;
  const Vector3d on_plane = *T_est_true * Vector3d(-plane.distance * plane.normal);
  const double slope = normal.dot(grid.normal);
  if (std::abs(slope) < 0.1) return std::nullopt;
  std::array<Vector3d, 4> border = grid.corners(0.5);
  for (Vector3d& corner : border) corner -= grid.normal * (normal.dot(corner - on_plane) / slope);
  return border;
}

std::array<Line, 3> confidence_ellipsoid(const Vector3d& center,
                                         const Matrix3d& covariance,
                                         double enlarged) {
  const Matrix3d axes = enlarged * semi_axes(covariance, kChiSquare3);
  std::array<Line, 3> lines;
  for (int k = 0; k < 3; ++k) {
    lines[k] = ellipse(axes.col(k), axes.col((k + 1) % 3), 48);
    for (Vector3d& point : lines[k]) point += center;
  }
  return lines;
}

NormalArrow normal_arrow(const Inspection& inspection, const PlaneGrid& grid) {
  const auto& cameras = inspection.initialization->cameras;
  Vector3d center = Vector3d::Zero();
  for (const Pose& pose : cameras)
    center += pose.p_wc / std::max<double>(1, static_cast<double>(cameras.size()));
  const auto [i0, j0] = grid.low;
  const auto [i1, j1] = grid.high;
  const double i = (i0 + i1) / 2.0, j = (j0 + j1) / 2.0;
  const std::array<Vector3d, 4> edges = {
      grid.at(i0, j), grid.at(i1, j), grid.at(i, j0), grid.at(i, j1)};
  const double length = 0.4 * grid.cell * std::min(i1 - i0, j1 - j0);
  NormalArrow arrow;
  arrow.base = *std::ranges::max_element(
      edges, {}, [&](const Vector3d& edge) { return (edge - center).norm(); });
  arrow.tip = arrow.base + length * grid.normal;
  const Vector3d back = arrow.tip - 0.14 * length * grid.normal;
  const Vector3d x = 0.05 * length * grid.x, y = 0.05 * length * grid.y;
  arrow.head = {back + x, back - x, back + y, back - y};
  return arrow;
}

Line confidence_rim(const NormalArrow& arrow, const Matrix3d& normal_covariance, double enlarged) {
  const Vector3d along = arrow.tip - arrow.base;
  // The first axis is along the normal, of variance zero.
  const Matrix3d axes = enlarged * semi_axes(normal_covariance, kChiSquare2);
  Line rim = ellipse(axes.col(1), axes.col(2), 48);
  for (Vector3d& turn : rim) turn = arrow.base + along.norm() * tilted(along.normalized(), turn);
  return rim;
}

std::vector<Vector2d> circle_on_disc(const Vector3d& normal, double radius_deg) {
  const Vector3d a = radians(radius_deg) * normal.unitOrthogonal();
  return ellipse_on_disc(normal, a, normal.cross(a));
}

std::vector<Vector2d> confidence_on_disc(const Vector3d& normal, const Matrix3d& covariance) {
  const Matrix3d axes = semi_axes(covariance, kChiSquare2);
  return ellipse_on_disc(normal, axes.col(1), axes.col(2));
}

Line scene_extent(const Inspection& inspection, double cube_side) {
  Line extent;
  const auto add = [&extent](const auto& points) {
    extent.insert(extent.end(), points.begin(), points.end());
  };
  add_frusta(inspection, extent);
  for (int axis = 0; axis < 3; ++axis)
    extent.push_back(axes_length(inspection) * Vector3d::Unit(axis));
  for (const PlanePatch& patch : refused_patches(inspection)) add(patch.corners);
  if (!inspection.initialization->ok) return extent;
  const PlaneGrid grid = plane_grid(inspection, cube_side);
  add(grid.corners());
  if (inspection.initialization->uncertainty) extent.push_back(normal_arrow(inspection, grid).tip);
  if (const auto border = true_plane_border(inspection, grid)) add(*border);
  if (inspection.cube) add(cube_corners(*inspection.cube, cube_side));
  return extent;
}

OrbitCamera default_scene_camera(const Inspection& inspection, double cube_side, double aspect) {
  OrbitCamera camera;
  camera.up = inspection.initialization->ok ? up_of(inspection) : Vector3d(-Vector3d::UnitY());
  // Forward along the plane as the reference camera sees it; upwards if it looks straight down.
  Vector3d ahead = Vector3d::UnitZ() - camera.up * camera.up.z();
  if (ahead.norm() < 0.2) ahead = -Vector3d::UnitY() + camera.up * camera.up.y();
  camera.front = ahead.normalized();
  camera.yaw_deg = 35;
  // A slanted plane is wide and low: taller views need a steeper pitch.
  camera.pitch_deg = std::clamp(42 - 13 * aspect, 25.0, 32.0);
  return fitted_to_all(camera, inspection, cube_side, aspect);
}

OrbitCamera scene_camera(
    const Inspection& inspection, double cube_side, double aspect, Viewpoint viewpoint, int frame) {
  constexpr double kSteepest_deg = 89;
  OrbitCamera camera = default_scene_camera(inspection, cube_side, aspect);
  if (viewpoint == Viewpoint::oblique) return camera;
  if (viewpoint == Viewpoint::camera && inspection.initialization->ok)
    return through_camera(inspection, aspect, frame);
  camera.yaw_deg = viewpoint == Viewpoint::side ? 90 : 0;
  camera.pitch_deg = viewpoint == Viewpoint::top ? kSteepest_deg : 0;
  return fitted_to_all(camera, inspection, cube_side, aspect);
}

}  // namespace gpo
