// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/camera_guess.h"

#include "engine/geometry/pose.h"

#include <cmath>

namespace gpo {

Camera camera_of_view(int width, int height, double diagonal_deg) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = 0.5 * std::hypot(width, height) / std::tan(radians(diagonal_deg) / 2);
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  return camera;
}

}  // namespace gpo
