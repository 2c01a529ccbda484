// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Items under the mouse in image and scene.
#pragma once

#include "ui/look/navigation.h"
#include "ui/views/image/image_view.h"

namespace gpo {

/// Items to highlight in all views.
struct Highlight {
  std::vector<int> picked;     ///< columns of tracks
  std::optional<int> focus;    ///< one of `picked`
  std::optional<int> hovered;  ///< column of a track
  std::optional<int> camera;   ///< hovered; frame of the window
};

/// Returns the column of the nearest track in the frame; nullopt if none is within `reach` [px].
std::optional<int> track_at(const Inspection& inspection,
                            int frame_in_window,
                            const ImageMapping& mapping,
                            const Eigen::Vector2d& screen_px,
                            double reach);

/// A pixel of the scene, from the view's top-left corner.
struct ScenePixel {
  const OrbitCamera& camera;
  Eigen::Vector2d view_size_px;
  Eigen::Vector2d pixel;

  /// Returns the pixel of a point; nullopt if it is behind the eye.
  std::optional<Eigen::Vector2d> pixel_of(const Eigen::Vector3d& point) const {
    return on_screen(camera, point, {.size = view_size_px});
  }
};

/// Returns the column of the nearest map point; nullopt if none is within `reach` [px].
std::optional<int> point_at(const Inspection& inspection, const ScenePixel& at, double reach);

/// Returns the frame of the window with the nearest camera center, in the same way.
std::optional<int> camera_at(const Inspection& inspection, const ScenePixel& at, double reach);

/// Intersects the pixel's ray with the estimated plane; nullopt if it misses, or without a plane.
std::optional<Eigen::Vector3d> plane_at(const Inspection& inspection, const ScenePixel& at);

/// Draws rings around the tracks in the image, and their paths through the window.
void draw_highlight_in_image(const Area& area,
                             const FrameView& view,
                             const ImageMapping& mapping,
                             const Highlight& highlight);

/// Draws rings around points and the hovered camera, rays from the focused or hovered point to the
/// cameras that see it, and the distance between two picked points.
void draw_highlight_in_scene(const Area& area,
                             const FrameView& view,
                             const OrbitCamera& camera,
                             const Highlight& highlight);

/// In meters if the accelerometer determines the scale, otherwise in plane distances.
std::string distance_text(const Inspection& inspection,
                          const Eigen::Vector3d& a,
                          const Eigen::Vector3d& b);

/// A place in the image, and sources of its values.
struct PixelReadout {
  const Inspection* inspection;  ///< may be null
  int frame;                     ///< counted in the recording
  const Camera& camera;
  const cv::Mat& bgr;      ///< CV_8UC3 of the frame; may be empty
  Eigen::Vector2d raw_px;  ///< the center of the first pixel is (0, 0)
  double scale;            ///< screen pixels per pixel
};
/// "x 312.4  y 201.8 px   gray 137   2.31 d away on plane 2 (wall)   250 %"; empty outside of the
/// image. The plane is that of the nearest track, within 5 % of the image's width.
std::string pixel_text(const PixelReadout& readout);

/// Draws the text at the lower left corner.
void draw_pixel_text(const Area& area, const std::string& text);

/// Draws lines between pixels if these are large enough on the screen.
void draw_pixel_grid(const Area& area, const ImageMapping& mapping, const Camera& camera);

}  // namespace gpo
