// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/look/orbit_camera.h"
#include "ui/look/rect.h"

#include <memory>

struct ImDrawList;

namespace gpo {

struct SolidModel;
struct TrackColors;

/// What is shown in the scene.
struct SceneViewOptions {
  bool cube = true;
  double cube_side = 0;                          ///< 0: `default_cube_side` [unit of the estimate]
  double cube_height_sides = 1;                  ///< more: a tower
  std::shared_ptr<const SolidModel> model = {};  ///< in the cube's place; null: none
  bool truth = true;                             ///< true cameras and plane, where they are known
  /// 95 % of the camera centers and of the normal, enlarged so many times; 0: not shown.
  int uncertainty = 1;
  int point_size_px = 5;  ///< at scale 1
  bool gravity = true;    ///< an arrow that points up, where gravity is known
  bool moving = false;    ///< dragged right now: coarser, so that it keeps up
  std::shared_ptr<const TrackColors> colors = {};  ///< of the points; null: by their planes
  bool legend = true;

  bool operator==(const SceneViewOptions&) const = default;
};

/// Whether it is asked for and known.
bool shows_uncertainty(const Inspection& inspection, const SceneViewOptions& options);

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
                  const SceneViewOptions& options,
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
                     const SceneViewOptions& options);

}  // namespace gpo
