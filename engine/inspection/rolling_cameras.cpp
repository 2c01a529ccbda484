// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/rolling_cameras.h"

#include <cmath>

namespace gpo {

std::optional<Readout> readout_of_truth(const Inspection& inspection) {
  const auto& known = inspection.recording->camera.readout;
  return known || !inspection.truth ? known : inspection.truth->estimated_readout;
}

RollingCamera rolling_camera(const Inspection& inspection, int frame) {
  RollingCamera camera{inspection.recording->camera};
  if (frame >= std::ssize(inspection.row_motions)) return camera;
  camera.row_delay_s = inspection.initialization->row_delay_s.value_or(0);
  camera.motion = inspection.row_motions[frame];
  return camera;
}

RollingCamera true_rolling_camera(const Inspection& inspection, int frame) {
  RollingCamera camera = rolling_camera(inspection, frame);
  const auto& plane = inspection.truth->plane;
  const auto& reference = inspection.truth->cameras.front();
  const double unit =
      plane && reference ? std::abs(plane_in_camera(*plane, *reference).distance) : 1;
  camera.motion = scaled(camera.motion, unit / inspection.initialization->plane.distance);
  if (const auto readout = readout_of_truth(inspection))
    camera.row_delay_s = readout->seconds / (readout_lines(camera.camera) - 1);
  return camera;
}

std::optional<Eigen::Vector3d> point_on_plane(const Inspection& inspection,
                                              int frame,
                                              const Eigen::Vector2d& raw_px,
                                              const Plane& plane) {
  const auto& cameras = inspection.initialization->cameras;
  if (frame < 0 || frame >= std::ssize(cameras)) return std::nullopt;
  return intersect(plane, cameras[frame], rolling_camera(inspection, frame), raw_px);
}

}  // namespace gpo
