// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/context/opengl.h"
#include "ui/views/overlay/overlay.h"

namespace gpo {

struct SolidModel;

struct ViewOptions {
  ViewToggles show = {};
  double cube_side = 0;                            ///< 0: the default [unit of the estimate]
  double cube_height_sides = 1;                    ///< more: a tower
  std::shared_ptr<const SolidModel> model = {};    ///< in the cube's place; null: none
  std::string model_error = {};                    ///< why it cannot be read; empty if it can
  std::shared_ptr<const TrackColors> colors = {};  ///< for tracks and points; null: by their planes
  /// Its cube is the reference of `ViewToggles::exaggeration` without a true cube. Null: none.
  const Inspection* reference = nullptr;
  double reference_side = 0;  ///< side of its cube, like `cube_side`
  bool moving = false;        ///< the user drags the scene: render it coarser, to keep up
  ImageZoom image_zoom = {};  ///< for `draw_image_view`
  std::optional<ImageZoom> compare_zoom = {};  ///< for all columns; nullopt: around the cubes
  bool top_line = true;  ///< above the comparison: frame and meaning of the cubes' colors

  bool operator==(const ViewOptions&) const = default;
};

/// One frame of an inspection, to be drawn with these options.
struct FrameView {
  const Inspection& inspection;
  int frame;  ///< counted in the recording; may be outside of the window
  const ViewOptions& options;

  int in_window() const { return frame - inspection.window->start; }
  bool inside() const { return in_window() >= 0 && in_window() < inspection.window->frame_count(); }
};

/// Draws a frame: the image, tracks, cube, legend, and the reason if the
/// initialization failed. `image` is null or empty if the recording has no images.
void draw_image_view(const Area& area, const FrameView& view, ImageTexture* image);

/// Returns the side of the virtual cube [unit of the estimate]: `chosen`, or the default if 0.
double cube_side(const Inspection& inspection, double chosen);

/// Returns an inspection with an empty window, for the views until a window has been computed.
Inspection nothing_to_show(std::shared_ptr<const Recording> recording);

}  // namespace gpo
