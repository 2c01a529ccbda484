// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/orbit_camera.h"

class vtkCamera;

namespace gpo {

/// Makes VTK see what the orbit camera sees.
void set_camera_from_orbit(vtkCamera& vtk, const OrbitCamera& camera);

}  // namespace gpo
