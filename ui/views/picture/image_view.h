// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/look/picture_zoom.h"
#include "ui/look/rect.h"

#include <memory>
#include <string>

struct ImDrawList;

namespace gpo {

class PictureTexture;
struct SolidModel;
struct TrackColors;

/// What is shown over the picture.
struct ImageViewOptions {
  bool tracks = true;                  ///< inliers and outliers of the frame
  int tail_frames = 10;                ///< how long a track's tail is; 0: none
  bool residuals = false;              ///< from the observation towards the reprojection
  double residual_magnification = 20;  ///< of their length [-]
  bool cube = true;                    ///< on the estimated plane, by the frame's estimated pose
  double cube_side = 0;                ///< 0: `default_cube_side` [unit of the estimate]
  double cube_height_sides = 1;        ///< more: a tower
  bool wireframe = false;              ///< the cube's edges alone
  std::shared_ptr<const SolidModel> model = {};  ///< in the cube's place; null: none
  std::string model_error = {};                  ///< why it could not be read; empty: it was
  /// The cube's distance in the picture from the true one, or where there is none from that of
  /// `reference`, so many times as large as it is.
  int exaggeration = 1;
  const Inspection* reference = nullptr;           ///< of the same window; null: none
  double reference_side = 0;                       ///< of its cube, as `cube_side`
  bool truth = true;                               ///< the true cube, where it is known
  bool gravity = true;                             ///< the horizon, where gravity is known
  bool undistorted = false;                        ///< as the pinhole camera would see it
  std::shared_ptr<const TrackColors> colors = {};  ///< of the tracks; null: by their planes
  bool legend = true;
};

/// Draws frame `frame` (counts in the recording) into the rectangle: the picture as it was
/// recorded, tracks, cube, legend, and the reason where the initialization failed. `picture` is
/// null, or empty, where the recording has no pictures.
void draw_image_view(ImDrawList& list,
                     const ScreenRect& rect,
                     const Inspection& inspection,
                     int frame,
                     PictureTexture* picture,
                     const PictureZoom& zoom,
                     const ImageViewOptions& options);

/// Side of the virtual cube: as chosen, or the default where `chosen` is 0 [unit of the estimate].
double cube_side(const Inspection& inspection, double chosen);

/// For the views, while nothing has been computed: a recording with an empty window.
Inspection nothing_inspected(std::shared_ptr<const Recording> recording);

}  // namespace gpo
