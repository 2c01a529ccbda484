// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "ui/look/picture_zoom.h"
#include "ui/views/model/solid_model.h"

#include <vector>

struct ImDrawList;

namespace gpo {

/// The model with its points at `points_w`, as the camera at `pose` sees it: the lens bends it,
/// too. Farther triangles first; those that are not wholly in front of the camera are left out.
void draw_model(ImDrawList& list,
                const PictureMapping& mapping,
                const Camera& camera,
                const Pose& pose,
                const SolidModel& model,
                const std::vector<Eigen::Vector3d>& points_w);

}  // namespace gpo
