// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "ui/look/zoom.h"
#include "ui/views/model/solid_model.h"
#include "ui/views/image/image_geometry.h"
#include "ui/views/image/image_texture.h"

#include <array>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <imgui.h>

struct ImDrawList;

namespace gpo {

/// The picture as it was recorded or without distortion, as the mapping says, and around it the
/// background. Null or empty: an empty field in its place.
void draw_image(ImDrawList& list,
                  const ScreenRect& rect,
                  const Camera& camera,
                  ImageTexture* image,
                  const ImageMapping& mapping);

/// The part of the picture within a triangle alone.
void draw_part(ImDrawList& list,
               const Camera& camera,
               const ImageTexture& image,
               const ImageMapping& mapping,
               const std::array<Eigen::Vector2d, 3>& triangle_raw_px);

/// Edges alone; those behind the cube are thin.
void draw_wireframe(ImDrawList& list, const ImageMapping& mapping, const CubeImage& cube);

/// As a body in soft light: brighter faces towards the light, darker towards its foot, edges in the
/// legend's green. `shadow`: `contact_shadow`.
void draw_body(ImDrawList& list,
               const ImageMapping& mapping,
               const CubeImage& cube,
               const std::vector<std::vector<Eigen::Vector2d>>& shadow);

/// What is on the plane alone, for a model that stands there: shadow and base.
void draw_foot(ImDrawList& list,
               const ImageMapping& mapping,
               const CubeImage& cube,
               const std::vector<std::vector<Eigen::Vector2d>>& shadow);

/// The corners on the screen of a box around all of its edges.
std::pair<ImVec2, ImVec2> bounds(const ImageMapping& mapping, const CubeImage& cube);

/// The true one: gray and dashed.
void draw_true_cube(ImDrawList& list, const ImageMapping& mapping, const CubeImage& cube);

/// The model with its points at `points_w`, as the camera at `pose` sees it: the lens bends it,
/// too. Farther triangles first; those that are not wholly in front of the camera are left out.
void draw_model(ImDrawList& list,
                const ImageMapping& mapping,
                const Camera& camera,
                const Pose& pose,
                const SolidModel& model,
                const std::vector<Eigen::Vector3d>& points_w);

}  // namespace gpo
