// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "ui/views/scene/orbit_camera.h"

class vtkCamera;

namespace gpo {

/// Makes VTK see exactly what the undistorted camera sees. What is drawn on must have the aspect of
/// the camera's picture.
void set_camera_from_intrinsics(vtkCamera& vtk, const Camera& camera, const Pose& pose);

void set_camera_from_orbit(vtkCamera& vtk, const OrbitCamera& camera);

}  // namespace gpo
