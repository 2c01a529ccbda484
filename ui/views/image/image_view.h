// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/studies/studies.h"
#include "ui/views/overlay/overlay.h"

namespace gpo {

struct SolidModel;

/// How finely the scene is rendered. Without a graphics card the number of samples decides on the
/// time. live: one sample per pixel; dragged: fewer pixels as well.
enum class SceneDetail { full, live, dragged };

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
  SceneDetail detail = SceneDetail::full;
  ImageZoom image_zoom = {};                   ///< for `draw_image_view`
  std::optional<ImageZoom> compare_zoom = {};  ///< for all columns; nullopt: around the cubes
  bool legend_line = false;  ///< the legend is in the margin, else a line over the image
  bool says_failure = true;  ///< a badge with the reason of a failed window
  std::shared_ptr<const Extrapolation> after = {};  ///< cameras after the window; null: none
  bool top_line = true;  ///< above the comparison: frame and meaning of the cubes' colors

  bool operator==(const ViewOptions&) const = default;
};

struct FrameView {
  const Inspection& inspection;
  int frame;  ///< counted in the recording; may be outside of the window
  const ViewOptions& options;

  int in_window() const { return frame - inspection.window->start; }
  bool inside() const { return in_window() >= 0 && in_window() < inspection.window->frame_count(); }
};

/// Returns the recording's image as all views show it.
ShownImage as_shown(const Recording& recording);
/// Returns its size [px].
cv::Size shown_size(const Recording& recording);

/// Draws image, tracks, cube, legend, or why it failed. `image`: null or empty without images.
/// Returns the rows of the legend that can be clicked; none without `legend_line`.
LegendHits draw_image_view(const Area& area, const FrameView& view, ImageTexture* image);

/// Returns the side of the virtual cube [unit of the estimate]: `chosen`, or the default if 0.
double cube_side(const Inspection& inspection, double chosen);

/// Returns an inspection with an empty window, for the views until a window has been computed.
Inspection nothing_to_show(std::shared_ptr<const Recording> recording);

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
                            const Vector2d& screen_px,
                            double reach);

/// A pixel of the scene, from the view's top-left corner.
struct ScenePixel {
  const OrbitCamera& camera;
  Vector2d view_size_px;
  Vector2d pixel;

  /// Returns the pixel of a point; nullopt if it is behind the eye.
  std::optional<Vector2d> pixel_of(const Vector3d& point) const {
    return on_screen(camera, point, {.size = view_size_px});
  }
};

/// Returns the column of the nearest map point; nullopt if none is within `reach` [px].
std::optional<int> point_at(const Inspection& inspection, const ScenePixel& at, double reach);

/// Returns the frame of the window with the nearest camera center, in the same way.
std::optional<int> camera_at(const Inspection& inspection, const ScenePixel& at, double reach);

/// A point on a plane of the window.
struct PlanePoint {
  int plane = 0;  ///< its number in the window
  Vector3d point = Vector3d::Zero();
};

/// Returns the nearest point of a further plane's patch, or of the leading plane, on the pixel's
/// ray; nullopt if it misses all, or without a plane. The leading plane has no border, but a patch
/// has priority over it.
std::optional<PlanePoint> plane_at(const Inspection& inspection, const ScenePixel& at);

/// Returns the intersection of the pixel's ray with a plane; nullopt if it misses.
std::optional<Vector3d> point_on_plane(const Plane& plane, const ScenePixel& at);

/// Returns the nearest cube at a pixel of the scene; nullopt if there is none.
std::optional<CubeAnchor> cube_at(const Inspection& inspection, double side, const ScenePixel& at);

/// Draws rings around the tracks in the image, and their paths through the window. If a finding
/// names repeated texture, also arrows in the reference frame to the places that look alike.
void draw_highlight_in_image(const Area& area,
                             const FrameView& view,
                             const ImageMapping& mapping,
                             const Highlight& highlight);

/// Draws one or two pixels as crosses; between two the line with their distance on the planes.
void draw_points(const Area& area,
                 const FrameView& view,
                 const ImageMapping& mapping,
                 std::span<const Vector2d> raw_px);

/// Draws highlighted points and camera, rays to the cameras that see a point, and a distance.
void draw_highlight_in_scene(const Area& area,
                             const FrameView& view,
                             const OrbitCamera& camera,
                             const Highlight& highlight);

/// In meters if the scale is known, otherwise in plane distances.
std::string distance_text(const Inspection& inspection, const Vector3d& a, const Vector3d& b);

struct PixelReadout {
  const Inspection* inspection;  ///< may be null
  int frame;                     ///< counted in the recording
  const Camera& camera;
  const cv::Mat& bgr;  ///< CV_8UC3 of the frame; may be empty
  Vector2d raw_px;     ///< the center of the first pixel is (0, 0)
  double scale;        ///< screen pixels per pixel
};
/// "x 312.4  y 201.8 px   gray 137   2.31 d away on plane 2 (wall)   250 %"; empty outside of the
/// image. The plane is that of the nearest track, within 5 % of the image's width.
std::string pixel_text(const PixelReadout& readout);

/// Draws the text at the lower left corner.
void draw_pixel_text(const Area& area, const std::string& text);

/// Draws lines between pixels if these are large enough on the screen.
void draw_pixel_grid(const Area& area, const ImageMapping& mapping);

}  // namespace gpo
