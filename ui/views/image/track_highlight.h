// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/look/orbit_camera.h"
#include "ui/look/zoom.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

struct ImDrawList;

namespace gpo {

/// What is lit up over the views, whichever of them the mouse is in.
struct Highlight {
  std::vector<int> picked;     ///< columns of tracks
  std::optional<int> focus;    ///< of `picked`
  std::optional<int> hovered;  ///< column of a track
  std::optional<int> camera;   ///< hovered; frame of the window
};

/// Column of the track nearest to a place on the screen, among those seen in the frame of the
/// window; nothing where none is within `reach` [screen px].
std::optional<int> track_at(const Inspection& inspection,
                            int frame_in_window,
                            const ImageMapping& mapping,
                            const Eigen::Vector2d& screen_px,
                            double reach);

/// The same among the map points of the scene; `pixel` counts from the view's top-left corner.
std::optional<int> point_at(const Inspection& inspection,
                            const OrbitCamera& camera,
                            const Eigen::Vector2d& view_size_px,
                            const Eigen::Vector2d& pixel,
                            double reach);

/// Frame of the window whose estimated camera center is nearest to a pixel of the scene.
std::optional<int> camera_at(const Inspection& inspection,
                             const OrbitCamera& camera,
                             const Eigen::Vector2d& view_size_px,
                             const Eigen::Vector2d& pixel,
                             double reach);

/// Where the ray through a pixel of the scene meets the estimated plane; nothing where it does not,
/// or there is none.
std::optional<Eigen::Vector3d> plane_at(const Inspection& inspection,
                                        const OrbitCamera& camera,
                                        const Eigen::Vector2d& view_size_px,
                                        const Eigen::Vector2d& pixel);

/// Rings around the tracks in the picture, and the way of each through the window.
void draw_highlight_in_image(ImDrawList& list,
                               const ScreenRect& rect,
                               const Inspection& inspection,
                               int frame_in_window,
                               const ImageMapping& mapping,
                               const Highlight& highlight);

/// How far apart two points of the estimate are: in meters where the accelerometer tells them, else
/// in distances of the plane.
std::string distance_text(const Inspection& inspection,
                          const Eigen::Vector3d& a,
                          const Eigen::Vector3d& b);

/// Rings around the points in the scene, rays from the one in focus or hovered to the cameras that
/// see it, the distance between two that are picked, and a ring around the hovered camera.
void draw_highlight_in_scene(ImDrawList& list,
                             const ScreenRect& rect,
                             const Inspection& inspection,
                             int frame_in_window,
                             const OrbitCamera& camera,
                             const Highlight& highlight);

}  // namespace gpo
