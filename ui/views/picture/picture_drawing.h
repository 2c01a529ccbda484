// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "ui/look/picture_zoom.h"
#include "ui/look/rect.h"
#include "ui/views/picture/picture_texture.h"

#include <array>

#include <Eigen/Core>

struct ImDrawList;

namespace gpo {

/// The picture as it was recorded or without distortion, as the mapping says, and around it the
/// background. Null or empty: an empty field in its place.
void draw_picture(ImDrawList& list,
                  const ScreenRect& rect,
                  const Camera& camera,
                  PictureTexture* picture,
                  const PictureMapping& mapping);

/// The part of the picture within a triangle alone.
void draw_part(ImDrawList& list,
               const Camera& camera,
               const PictureTexture& picture,
               const PictureMapping& mapping,
               const std::array<Eigen::Vector2d, 3>& triangle_raw_px);

}  // namespace gpo
