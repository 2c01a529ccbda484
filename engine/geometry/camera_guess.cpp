// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/camera_guess.h"

#include "engine/geometry/pose.h"

#include <cmath>

namespace gpo {

Camera camera_of_focal(int width, int height, double focal_diagonals) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = focal_diagonals * std::hypot(width, height);
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  return camera;
}

Camera camera_of_view(int width, int height, double diagonal_deg) {
  return camera_of_focal(width, height, 0.5 / std::tan(radians(diagonal_deg) / 2));
}

}  // namespace gpo
