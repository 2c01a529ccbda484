// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/picture/model_drawing.h"

#include "ui/context/theme.h"
#include "ui/views/overlay/overlay.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include <imgui.h>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Of the triangles in front of the camera, the farthest first.
std::vector<std::size_t> far_to_near(const SolidModel& model,
                                     const std::vector<Vector3d>& points_c,
                                     const std::vector<Vector2d>& screen) {
  std::vector<std::pair<double, std::size_t>> depths;
  for (std::size_t i = 0; i < model.triangles.size(); ++i) {
    const auto seen = [&](int corner) { return screen[corner].allFinite(); };
    if (!std::ranges::all_of(model.triangles[i], seen)) continue;
    double depth = 0;
    for (const int corner : model.triangles[i]) depth += points_c[corner].norm();
    depths.emplace_back(-depth, i);
  }
  std::ranges::sort(depths);
  std::vector<std::size_t> order;
  order.reserve(depths.size());
  for (const auto& [depth, triangle] : depths) order.push_back(triangle);
  return order;
}

void fill_triangles(ImDrawList& list,
                    const SolidModel& model,
                    const std::vector<Vector2d>& screen,
                    std::span<const std::size_t> triangles) {
  const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
  const std::uint32_t cube_rgb = color_of(Role::cube_face);
  const auto count = static_cast<int>(triangles.size());
  list.PrimReserve(3 * count, 3 * count);
  for (const std::size_t triangle : triangles) {
    for (const int corner : model.triangles[triangle]) {
      const double light = light_above_ground(model.points[corner].z());
      const ImU32 color = imgui_color(lit_rgb(model, triangle, cube_rgb, light));
      list.PrimVtx(to_imgui(screen[corner]), white, color);
    }
  }
}

}  // namespace

void draw_model(ImDrawList& list,
                const PictureMapping& mapping,
                const Camera& camera,
                const Pose& pose,
                const SolidModel& model,
                const std::vector<Vector3d>& points_w) {
  constexpr std::size_t kAtOnce = 10'000;  // their corners' indices fit into 16 bits
  std::vector<Vector3d> points_c;
  std::vector<Vector2d> screen;
  points_c.reserve(points_w.size());
  screen.reserve(points_w.size());
  for (const Vector3d& point : points_w) {
    points_c.push_back(to_camera(pose, point));
    const bool in_front = points_c.back().z() > 0;
    screen.push_back(in_front ? to_screen(mapping, project(camera, points_c.back()))
                              : Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
  }
  const auto order = far_to_near(model, points_c, screen);
  for (std::size_t first = 0; first < order.size(); first += kAtOnce)
    fill_triangles(list,
                   model,
                   screen,
                   std::span(order).subspan(first, std::min(kAtOnce, order.size() - first)));
}

}  // namespace gpo
