// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/scene/scene_geometry.h"

#include "engine/inspection/plane_names.h"
#include "engine/inspection/studies/plane_patches.h"
#include "engine/truth/truth.h"
#include "ui/views/scene/plane_grid.h"
#include "ui/views/scene/uncertainty_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace gpo {
namespace {

using Eigen::Vector3d;

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

void add_frusta(const Inspection& inspection, std::vector<Vector3d>& extent) {
  const double depth = frustum_depth(inspection);
  const auto add = [&](const Pose& pose) {
    for (const Vector3d& corner : frustum(inspection.recording->camera, pose, depth))
      extent.push_back(corner);
  };
  for (const Pose& pose : found_cameras(*inspection.initialization)) add(pose);
  const auto T_est_true = estimate_from_truth(inspection);
  if (!T_est_true) return;
  for (int i = 0; i < static_cast<int>(inspection.truth->cameras.size()); ++i)
    if (const auto pose = true_camera(inspection, *T_est_true, i)) add(*pose);
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
  const std::vector<Pose>& cameras = found_cameras(estimate);
  if (cameras.empty()) return 0.08;
  const double distance = estimate.ok ? estimate.plane.distance : estimate.refused->plane.distance;
  Vector3d low = Vector3d::Zero(), high = Vector3d::Zero();
  for (const Pose& pose : cameras) {
    low = low.cwiseMin(pose.p_wc);
    high = high.cwiseMax(pose.p_wc);
  }
  return std::clamp(0.3 * (high - low).norm(), 0.09 * distance, 0.14 * distance);
}

double axes_length(const Inspection& inspection) { return 1.6 * frustum_depth(inspection); }

int frustum_stride(const Inspection& inspection) {
  return std::max(1, (inspection.window->frame_count() + 5) / 10);
}

std::vector<Vector3d> scene_extent(const Inspection& inspection, double cube_side) {
  std::vector<Vector3d> extent;
  add_frusta(inspection, extent);
  for (int axis = 0; axis < 3; ++axis)
    extent.push_back(axes_length(inspection) * Vector3d::Unit(axis));
  if (const auto patch = refused_patch(inspection))
    extent.insert(extent.end(), patch->corners.begin(), patch->corners.end());
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

namespace {

/// The leading plane is the ground, as the method sees it; where gravity says that it is none, the
/// scene stands upright by gravity.
Vector3d up_of(const Inspection& inspection) {
  const auto name = plane_name(inspection, inspection.window->leader);
  const bool ground = !name || name->name == "floor" || name->name == "table";
  return ground ? inspection.initialization->plane.normal
                : Vector3d(-inspection.inertial->gravity_m_s2.normalized());
}

}  // namespace

namespace {

OrbitCamera fitted_to_all(const OrbitCamera& camera,
                          const Inspection& inspection,
                          double cube_side,
                          double aspect) {
  std::vector<Vector3d> extent = scene_extent(inspection, cube_side);
  for (const PlanePatch& patch : plane_patches(inspection))
    extent.insert(extent.end(), patch.corners.begin(), patch.corners.end());
  return fitted(camera, extent, aspect, {.bottom = 0.24});
}

/// Where a camera of the window is, with a picture as high as it takes to show all of its own.
OrbitCamera through_camera(const Inspection& inspection, double aspect, int frame) {
  const auto& cameras = inspection.initialization->cameras;
  const int last = static_cast<int>(cameras.size()) - 1;
  const Pose& pose = cameras[std::clamp(frame - inspection.window->start, 0, last)];
  const Camera& lens = inspection.recording->camera;
  const double half_height =
      std::max(lens.height / (2 * lens.fy), lens.width / (2 * lens.fx) / aspect);
  OrbitCamera camera;
  camera.up = -pose.R_wc.col(1);
  camera.front = pose.R_wc.col(2);
  camera.yaw_deg = 0;
  camera.pitch_deg = 0;
  camera.distance = plane_in_camera(inspection.initialization->plane, pose).distance;
  camera.target = pose.p_wc + camera.distance * camera.front;
  camera.view_angle_deg = 2 * std::atan(half_height) * 180 / std::numbers::pi;
  return camera;
}

}  // namespace

OrbitCamera default_scene_camera(const Inspection& inspection, double cube_side, double aspect) {
  OrbitCamera camera;
  camera.up = inspection.initialization->ok ? up_of(inspection) : Vector3d(-Vector3d::UnitY());
  // Forward along the plane as the reference camera sees it; where it looks straight down, up.
  Vector3d ahead = Vector3d::UnitZ() - camera.up * camera.up.z();
  if (ahead.norm() < 0.2) ahead = -Vector3d::UnitY() + camera.up * camera.up.y();
  camera.front = ahead.normalized();
  camera.yaw_deg = 35;
  // A plane seen at a slant is wide and low: the taller the view, the steeper it is looked upon.
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
