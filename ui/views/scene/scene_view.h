// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/orbit_camera.h"
#include "ui/views/image/image_view.h"

namespace gpo {

/// Returns true if the uncertainty is switched on and known.
bool shows_uncertainty(const Inspection& inspection, const ViewOptions& options);

/// The estimate in 3-D, rendered by VTK. Needs the context in which it was created to be current.
class SceneView {
 public:
  SceneView();
  ~SceneView();
  SceneView(const SceneView&) = delete;
  SceneView& operator=(const SceneView&) = delete;

  /// Returns the texture of the scene without items of a single frame, bottom row first; 0 for an
  /// empty size. Renders only after a change.
  unsigned render(const Inspection& inspection,
                  const ViewOptions& options,
                  const OrbitCamera& camera,
                  cv::Size size);
  std::size_t renders() const;

 private:
  struct Pipeline;
  std::unique_ptr<Pipeline> pipeline_;
};

/// Draws the scene into the rectangle (whole pixels), and over it the frame's camera, labels,
/// legend and scale bar.
void draw_scene_view(const Area& area,
                     const FrameView& view,
                     SceneView& scene,
                     const OrbitCamera& camera);

}  // namespace gpo
