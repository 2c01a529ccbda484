// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/scene/scene_moment.h"

#include "engine/initializers/methods.h"
#include "ui/context/theme.h"
#include "ui/views/overlay/overlay.h"
#include "ui/views/scene/scene_geometry.h"
#include "ui/views/scene/uncertainty_geometry.h"

#include <imgui.h>

namespace gpo {
namespace {

using Eigen::Vector3d;

/// Lines and faces in space on their way to the screen.
struct Projection {
  ImDrawList& list;
  ScreenRect rect;
  OrbitCamera camera;

  std::optional<ImVec2> at(const Vector3d& point) const {
    const auto pixel = view_pixel(camera, point, rect.size);
    return pixel ? std::optional(to_imgui(rect.min + *pixel)) : std::nullopt;
  }
  void line(const Vector3d& a, const Vector3d& b, std::uint32_t rgb, float width_px) const {
    const auto visible = in_front(camera, a, b);
    if (!visible) return;
    const auto from = at((*visible)[0]), to = at((*visible)[1]);
    if (from && to) list.AddLine(*from, *to, imgui_color(rgb), width_px * overlay_scale());
  }
  void closed(std::span<const Vector3d> points, std::uint32_t rgb, float width_px) const {
    for (std::size_t i = 0; i < points.size(); ++i)
      line(points[i], points[(i + 1) % points.size()], rgb, width_px);
  }
  /// Its border is to be drawn, too: it is not smooth.
  void face(std::span<const Vector3d> corners, std::uint32_t rgb, double alpha) const {
    std::vector<ImVec2> pixels;
    for (const Vector3d& corner : corners) {
      const auto pixel = at(corner);
      if (!pixel) return;
      pixels.push_back(*pixel);
    }
    const ImDrawListFlags flags = list.Flags;
    list.Flags &= ~ImDrawListFlags_AntiAliasedFill;
    const int count = static_cast<int>(pixels.size());
    list.AddConvexPolyFilled(pixels.data(), count, imgui_color(rgb, alpha));
    list.Flags = flags;
  }
  void frustum(const std::array<Vector3d, 6>& corners, std::uint32_t rgb, float width_px) const {
    for (int k = 1; k <= 4; ++k) line(corners[0], corners[k], rgb, width_px);
    closed(std::span(corners).subspan(1, 4), rgb, width_px);
  }
};

void draw_true_camera(const Projection& projection,
                      const Inspection& inspection,
                      int frame_in_window) {
  const auto T_est_true = estimate_from_truth(inspection);
  if (!T_est_true) return;
  const auto pose = true_camera(inspection, *T_est_true, frame_in_window);
  if (!pose) return;
  const double depth = 0.75 * frustum_depth(inspection);
  projection.frustum(frustum(inspection.recording->camera, *pose, depth), color_of(Role::truth), 2);
}

void draw_uncertainty(const Projection& projection,
                      const Inspection& inspection,
                      int frame_in_window,
                      double enlarged) {
  const Initialization& estimate = *inspection.initialization;
  const auto& covariances = estimate.uncertainty->center_covariances;
  if (frame_in_window == 0 || frame_in_window >= std::ssize(covariances)) return;
  const auto ellipsoid = confidence_ellipsoid(
      estimate.cameras[frame_in_window].p_wc, covariances[frame_in_window], enlarged);
  for (const auto& line : ellipsoid) projection.closed(line, color_of(Role::uncertain), 1.2F);
}

/// The frame's camera as it is drawn: which edge of its picture is up is marked. The reference
/// camera keeps its color.
struct MarkedFrustum {
  std::array<Vector3d, 6> corners;
  std::array<Vector3d, 3> mark;
  std::uint32_t rgb;

  void draw_faces(const Projection& projection) const {
    projection.face(std::span(corners).subspan(1, 4), rgb, 0.2);
    projection.face(mark, rgb, 0.4);
  }
  void draw_lines(const Projection& projection) const {
    projection.frustum(corners, rgb, 2.6F);
    projection.closed(mark, rgb, 2.6F);
  }
};
MarkedFrustum marked_frustum(const Inspection& inspection, int frame_in_window) {
  const std::uint32_t method = find_method(inspection.settings.method).rgb;
  const auto corners = frustum(inspection.recording->camera,
                               inspection.initialization->cameras[frame_in_window],
                               frustum_depth(inspection));
  return {corners,
          {corners[1], corners[2], corners[5]},
          frame_in_window == 0 ? color_of(Role::reference)
                               : mixed_rgb(method, color_of(Role::text), 0.35)};
}

}  // namespace

void draw_scene_moment(ImDrawList& list,
                       const ScreenRect& rect,
                       const Inspection& inspection,
                       int frame_in_window,
                       const OrbitCamera& camera,
                       const ViewOptions& options) {
  const Projection projection{list, rect, camera};
  const bool in_window = frame_in_window >= 0 && frame_in_window < inspection.window->frame_count();
  if (!in_window) return;
  const Initialization& estimate = *inspection.initialization;
  std::optional<MarkedFrustum> marked;
  if (estimate.ok && frame_in_window < std::ssize(estimate.cameras))
    marked = marked_frustum(inspection, frame_in_window);
  // Faces first: they would hide the lines behind them.
  if (marked) marked->draw_faces(projection);
  if (options.show.truth) draw_true_camera(projection, inspection, frame_in_window);
  if (marked && shows_uncertainty(inspection, options))
    draw_uncertainty(projection, inspection, frame_in_window, options.show.uncertainty);
  if (marked) marked->draw_lines(projection);
}

}  // namespace gpo
