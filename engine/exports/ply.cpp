// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/exports/scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {

std::string ply_text(const ExportScene& scene, ExportNotes& notes) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\ncomment {}\ncomment plane: number in the window, from 1, 0: on none; "
      "residual: "
      "RMS reprojection error [px]\nelement vertex {}\nproperty double x\nproperty double y\n"
      "property double z\nproperty int track\nproperty uchar red\nproperty uchar green\nproperty "
      "uchar blue\nproperty double nx\nproperty double ny\nproperty double nz\nproperty int plane\n"
      "property double residual\nend_header\n",
      scene.world.description(),
      scene.points.size());
  for (const ScenePoint& point : scene.points) {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    if (const Plane* plane =
            point.plane ? estimated_plane(scene.inspection, *point.plane) : nullptr)
      normal = scene.world.T_world_reference.R_ab * plane->normal;
    text += fmt::format("{:.9f} {} {} {:.9f} {} {:.6f}\n",
                        fmt::join(point.position, " "),
                        scene.inspection.tracks->ids[point.track],
                        fmt::join(point.color, " "),
                        fmt::join(normal, " "),
                        point.plane ? *point.plane + 1 : 0,
                        point.rms_px);
  }
  notes.push_back(fmt::format("{} of {}; {}",
                              counted(scene.points.size(), "point"),
                              counted(scene.planes.size(), "plane"),
                              scene.world.description()));
  for (const std::string& left_out : scene.left_out) notes.push_back("left out: " + left_out);
  return text;
}

}  // namespace gpo
