// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/look/orbit_camera.h"
#include "ui/look/view_toggles.h"

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Brings the truth into the estimate's world: by the aligned paths where they determine it, else
/// by the reference camera and a scale (the alignment's, or the plane's true distance). Nothing
/// where neither is known.
std::optional<Similarity> estimate_from_truth(const Inspection& inspection);

/// The true camera of a frame of the window in the estimate's world.
std::optional<Pose> true_camera(const Inspection& inspection,
                                const Similarity& T_est_true,
                                int frame_in_window);

/// The camera's center, the corners of its picture at that depth (top-left, top-right,
/// bottom-right, bottom-left), and the tip of a mark above the upper edge.
std::array<Eigen::Vector3d, 6> frustum(const Camera& camera, const Pose& pose, double depth);

/// Those of the estimate, or of what was refused; empty where there is neither.
const std::vector<Pose>& found_cameras(const Initialization& estimate);

/// How deep the frusta are drawn, so that they neither hide each other nor vanish.
double frustum_depth(const Inspection& inspection);

/// Of the world's axes, as they are drawn.
double axes_length(const Inspection& inspection);

/// Every so many frames a frustum is drawn, so that some ten make the path.
int frustum_stride(const Inspection& inspection);

/// Where the cameras (also the true ones), the plane and the cube are: what a view must contain.
std::vector<Eigen::Vector3d> scene_extent(const Inspection& inspection, double cube_side);

/// From behind the reference camera, above and beside it, everything in view.
OrbitCamera default_scene_camera(const Inspection& inspection, double cube_side, double aspect);

/// From a viewpoint, everything in view; through the camera of a frame (counts in the recording;
/// the nearest of the window): all of its picture.
OrbitCamera scene_camera(
    const Inspection& inspection, double cube_side, double aspect, Viewpoint viewpoint, int frame);

}  // namespace gpo
