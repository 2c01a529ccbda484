// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/look/orbit_camera.h"
#include "ui/look/zoom.h"
#include "ui/views/overlay/view_options.h"

#include <memory>

struct ImDrawList;

namespace gpo {

/// Whether it is asked for and known.
bool shows_uncertainty(const Inspection& inspection, const ViewOptions& options);

/// The estimate in 3-D, by VTK. Needs the context in which it was made to be current.
class SceneView {
 public:
  SceneView();
  ~SceneView();
  SceneView(const SceneView&) = delete;
  SceneView& operator=(const SceneView&) = delete;

  /// The texture of the rendered scene, bottom row first; 0 for an empty size. Renders only when
  /// something has changed since the last call; what belongs to a single frame is not in it.
  unsigned render(const Inspection& inspection,
                  const OrbitCamera& camera,
                  const ViewOptions& options,
                  int width,
                  int height);

  /// How often something had changed.
  std::size_t renders() const;

 private:
  struct Pipeline;
  std::unique_ptr<Pipeline> pipeline_;
};

/// Draws the scene into the rectangle (whole pixels), and over it the frame's camera, labels,
/// legend and scale bar. `frame` counts in the recording.
void draw_scene_view(ImDrawList& list,
                     const ScreenRect& rect,
                     SceneView& view,
                     const Inspection& inspection,
                     int frame,
                     const OrbitCamera& camera,
                     const ViewOptions& options);

}  // namespace gpo
