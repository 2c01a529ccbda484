// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/view_toggles.h"
#include "ui/look/zoom.h"

#include <memory>
#include <optional>
#include <string>

namespace gpo {

struct Inspection;
struct SolidModel;
struct TrackColors;

/// What the views show, and how.
struct ViewOptions {
  ViewToggles show = {};
  double cube_side = 0;                            ///< 0: the default [unit of the estimate]
  double cube_height_sides = 1;                    ///< more: a tower
  std::shared_ptr<const SolidModel> model = {};    ///< in the cube's place; null: none
  std::string model_error = {};                    ///< why it could not be read; empty: it was
  std::shared_ptr<const TrackColors> colors = {};  ///< of tracks and points; null: by their planes
  /// Of the same window: its cube is the reference of `ViewToggles::exaggeration` in the picture
  /// where there is no true one. Null: none.
  const Inspection* reference = nullptr;
  double reference_side = 0;  ///< of its cube, as `cube_side`
  bool moving = false;        ///< the scene is being dragged: coarser, so that it keeps up
  std::optional<ImageZoom> compare_zoom = {};  ///< of all columns; nothing: around the cubes
  bool top_line = true;  ///< of the comparison: the frame, and what the cubes' colors mean

  bool operator==(const ViewOptions&) const = default;
};

}  // namespace gpo
