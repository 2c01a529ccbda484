// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/picture_zoom.h"
#include "ui/views/picture/image_geometry.h"

#include <utility>
#include <vector>

#include <imgui.h>

namespace gpo {

/// Edges alone; those behind the cube are thin.
void draw_wireframe(ImDrawList& list, const PictureMapping& mapping, const CubePicture& cube);

/// As a body in soft light: brighter faces towards the light, darker towards its foot, edges in the
/// legend's green. `shadow`: `contact_shadow`.
void draw_body(ImDrawList& list,
               const PictureMapping& mapping,
               const CubePicture& cube,
               const std::vector<std::vector<Eigen::Vector2d>>& shadow);

/// What is on the plane alone, for a model that stands there: shadow and base.
void draw_foot(ImDrawList& list,
               const PictureMapping& mapping,
               const CubePicture& cube,
               const std::vector<std::vector<Eigen::Vector2d>>& shadow);

/// The corners on the screen of a box around all of its edges.
std::pair<ImVec2, ImVec2> bounds(const PictureMapping& mapping, const CubePicture& cube);

/// The true one: gray and dashed.
void draw_true_cube(ImDrawList& list, const PictureMapping& mapping, const CubePicture& cube);

}  // namespace gpo
