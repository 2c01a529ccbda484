// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/image/pixel_readout.h"

#include "engine/inspection/plane_names.h"
#include "engine/window/tracks.h"
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/look/numbers.h"
#include "ui/views/overlay/overlay.h"
#include "ui/views/overlay/plane_style.h"
#include "ui/views/image/image_geometry.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace gpo {
namespace {

using Eigen::Vector2d;

std::string color_text(const cv::Mat& bgr, const Vector2d& raw_px) {
  const cv::Point pixel(static_cast<int>(std::lround(raw_px.x())),
                        static_cast<int>(std::lround(raw_px.y())));
  if (bgr.empty() || !cv::Rect({0, 0}, bgr.size()).contains(pixel)) return "";
  const auto& at = bgr.at<cv::Vec3b>(pixel);
  if (at[0] == at[1] && at[1] == at[2]) return fmt::format("   gray {}", at[0]);
  return fmt::format("   RGB {} {} {}", at[2], at[1], at[0]);
}

/// Number of the plane that the nearest track lies on.
std::optional<int> plane_near(const Inspection& inspection, int frame, const Vector2d& raw_px) {
  const Tracks& tracks = *inspection.tracks;
  double nearest = 0.05 * inspection.recording->camera.width;
  std::optional<int> plane;
  for (int column = 0; column < tracks.track_count(); ++column) {
    if (!tracks.seen(frame, column)) continue;
    const double distance = (tracks.raw_px[frame].col(column) - raw_px).norm();
    const auto on = plane_of_track(*inspection.window, frame, column);
    if (distance >= nearest || !on) continue;
    nearest = distance;
    plane = on;
  }
  return plane;
}

/// How far the plane under the pixel is from the frame's camera, along the ray.
std::string plane_text(const Inspection& inspection, int frame, const Vector2d& raw_px) {
  const Initialization& result = *inspection.initialization;
  if (!result.ok || frame < 0 || frame >= static_cast<int>(result.cameras.size())) return "";
  const auto number = plane_near(inspection, frame, raw_px);
  if (!number) return "";
  const std::string title = plane_title(inspection, *number);
  const auto estimated = std::ranges::find(result.planes, *number, &PlaneEstimate::number);
  const bool leads = *number == inspection.window->leader;
  if (!leads && estimated == result.planes.end()) return "   on " + title;
  const Plane& plane = leads ? result.plane : estimated->plane;
  const auto point = point_on_plane(inspection, frame, raw_px, plane);
  if (!point) return "   on " + title;
  const double away = (*point - result.cameras[frame].p_wc).norm();
  const auto meters = known_scale(inspection);
  return fmt::format("   {} away on {}",
                     meters ? length_text(*meters * away) : fmt::format("{:.2f} d", away),
                     title);
}

}  // namespace

std::string pixel_text(const Inspection* inspection,
                       int frame,
                       const Camera& camera,
                       const cv::Mat& bgr,
                       const Vector2d& raw_px,
                       double scale) {
  const bool inside = raw_px.x() >= -0.5 && raw_px.y() >= -0.5 && raw_px.x() < camera.width - 0.5 &&
                      raw_px.y() < camera.height - 0.5;
  if (!inside) return "";
  std::string text = fmt::format("x {:.1f}  y {:.1f} px", raw_px.x(), raw_px.y());
  text += color_text(bgr, raw_px);
  if (inspection != nullptr)
    text += plane_text(*inspection, frame - inspection->window->start, raw_px);
  return text + fmt::format("   {:.0f} %", 100 * scale);
}

void draw_pixel_grid(ImDrawList& list,
                     const ScreenRect& rect,
                     const ImageMapping& mapping,
                     const Camera& camera) {
  constexpr double kLeastScale = 8;
  // Without the lens' distortion pixels are no squares.
  if (mapping.scale < kLeastScale * overlay_scale() || mapping.undistorted != nullptr) return;
  const ImU32 color = imgui_color(Role::text, 0.12);
  const Vector2d first = to_image(mapping, rect.min);
  const Vector2d last = to_image(mapping, rect.min + rect.size);
  const int left = std::max(0, static_cast<int>(first.x()));
  const int right = std::min(camera.width, static_cast<int>(last.x()) + 1);
  const int top = std::max(0, static_cast<int>(first.y()));
  const int bottom = std::min(camera.height, static_cast<int>(last.y()) + 1);
  const auto line = [&](double u0, double v0, double u1, double v1) {
    list.AddLine(
        to_imgui(to_screen(mapping, {u0, v0})), to_imgui(to_screen(mapping, {u1, v1})), color);
  };
  for (int u = left; u <= right; ++u) line(u - 0.5, top - 0.5, u - 0.5, bottom - 0.5);
  for (int v = top; v <= bottom; ++v) line(left - 0.5, v - 0.5, right - 0.5, v - 0.5);
}

void draw_pixel_text(ImDrawList& list, const ScreenRect& rect, const std::string& text) {
  if (text.empty()) return;
  const float s = overlay_scale();
  const ImFont* f = font(Font::small);
  const ImVec2 size = f->CalcTextSizeA(f->FontSize, 1e6F, 0, text.c_str());
  const ImVec2 corner = to_imgui(rect.min + Vector2d(0, rect.size.y()));
  const ImVec2 at(std::round(corner.x), std::round(corner.y - size.y - 6 * s));
  list.AddRectFilled(
      at, {std::round(at.x + size.x + 16 * s), corner.y}, imgui_color(Role::background, 0.8));
  write_text(list, Font::small, {at.x + 8 * s, at.y + 3 * s}, text);
}

}  // namespace gpo
