// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/scene/vtk_camera.h"

#include <Eigen/Core>
#include <vtkCamera.h>

namespace gpo {

void set_camera_from_orbit(vtkCamera& vtk, const OrbitCamera& camera) {
  const Eigen::Vector3d position = eye(camera);
  const Eigen::Vector3d up = -view_axes(camera).col(1);
  vtk.SetPosition(position.x(), position.y(), position.z());
  vtk.SetFocalPoint(camera.target.x(), camera.target.y(), camera.target.z());
  vtk.SetViewUp(up.x(), up.y(), up.z());
  vtk.SetViewAngle(camera.view_angle_deg);
}

}  // namespace gpo
