// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/scene/vtk_camera.h"

#include <cmath>

#include <Eigen/Core>
#include <vtkCamera.h>
#include <vtkNew.h>
#include <vtkTransform.h>

namespace gpo {
namespace {

void place(vtkCamera& vtk,
           const Eigen::Vector3d& position,
           const Eigen::Vector3d& focal_point,
           const Eigen::Vector3d& up) {
  vtk.SetPosition(position.x(), position.y(), position.z());
  vtk.SetFocalPoint(focal_point.x(), focal_point.y(), focal_point.z());
  vtk.SetViewUp(up.x(), up.y(), up.z());
}

}  // namespace

void set_camera_from_intrinsics(vtkCamera& vtk, const Camera& camera, const Pose& pose) {
  const double w = camera.width, h = camera.height;
  place(vtk, pose.p_wc, pose.p_wc + pose.R_wc.col(2), -pose.R_wc.col(1));
  vtk.SetViewAngle(degrees(2 * std::atan(h / 2 / camera.fy)));
  // The window's center is given before the pixels' aspect is applied, hence fy / fx.
  vtk.SetWindowCenter(-2 * (camera.cx - (w - 1) / 2) / w * camera.fy / camera.fx,
                      2 * (camera.cy - (h - 1) / 2) / h);
  vtkNew<vtkTransform> aspect;
  aspect->Scale(camera.fx / camera.fy, 1, 1);
  vtk.SetUserTransform(aspect);
}

void set_camera_from_orbit(vtkCamera& vtk, const OrbitCamera& camera) {
  place(vtk, eye(camera), camera.target, -view_axes(camera).col(1));
  vtk.SetViewAngle(camera.view_angle_deg);
  vtk.SetWindowCenter(0, 0);
  vtk.SetUserTransform(nullptr);
}

}  // namespace gpo
