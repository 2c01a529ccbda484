// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "ui/context/opengl.h"
#include "ui/views/image/image_geometry.h"
#include "ui/views/overlay/overlay.h"

#include <utility>

namespace gpo {

struct ImageCanvas : Area {
  const Camera& camera;
  ImageMapping mapping;

  ImVec2 at(const Eigen::Vector2d& raw_px) const { return to_imgui(to_screen(mapping, raw_px)); }
  /// `width` at scale 1 [px].
  void polyline(const Outline& raw_px, ImU32 color, float width) const;
};

/// Draws the image and the background around it; an empty field if the texture is null or empty.
void draw_image(const ImageCanvas& canvas, ImageTexture* image);

/// Draws the part of the image within a triangle.
void draw_part(const ImageCanvas& canvas, const ImageTexture& image, const Triangle& triangle);

/// Draws only edges; those behind the cube are thin.
void draw_wireframe(const ImageCanvas& canvas, const CubeImage& cube);

/// Draws the cube as a body in soft light, darker towards its foot; with a model in its place only
/// shadow and base. `rings`: `contact_shadow`.
void draw_body(const ImageCanvas& canvas, const CubeImage& cube, const Outlines& rings, bool model);

/// Returns the corners on the screen of a box around all edges.
std::pair<ImVec2, ImVec2> bounds(const ImageCanvas& canvas, const CubeImage& cube);

/// Draws the true cube, gray and dashed.
void draw_true_cube(const ImageCanvas& canvas, const CubeImage& cube);

/// Draws the model's triangles in front of the camera from far to near, its points at `points_w`.
void draw_model(const ImageCanvas& canvas,
                const Pose& pose,
                const SolidModel& model,
                const std::vector<Eigen::Vector3d>& points_w);

}  // namespace gpo
