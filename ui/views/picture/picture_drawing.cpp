// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/picture/picture_drawing.h"

#include "ui/context/theme.h"
#include "ui/context/window_picture.h"
#include "ui/views/overlay/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <imgui.h>

namespace gpo {
namespace {

using Eigen::Vector2d;

/// Only what the picture leaves free: without a graphics card each layer costs milliseconds.
void draw_surroundings(ImDrawList& list,
                       const ScreenRect& rect,
                       const ImVec2& picture_low,
                       const ImVec2& picture_high) {
  const ImU32 color = imgui_color(Role::background);
  const ImVec2 low = to_imgui(rect.min), high = to_imgui(rect.min + rect.size);
  // The picture's last pixels are whole ones only where its scale is.
  const float right = std::clamp(std::floor(picture_high.x), low.x, high.x);
  const float bottom = std::clamp(std::floor(picture_high.y), low.y, high.y);
  const float left = std::clamp(picture_low.x, low.x, right);
  const float top = std::clamp(picture_low.y, low.y, bottom);
  const std::array<std::pair<ImVec2, ImVec2>, 4> sides = {{{low, {high.x, top}},
                                                           {{low.x, bottom}, high},
                                                           {{low.x, top}, {left, bottom}},
                                                           {{right, top}, {high.x, bottom}}}};
  for (const auto& [from, to] : sides)
    if (to.x > from.x && to.y > from.y) list.AddRectFilled(from, to, color);
}

constexpr int kCells = 64;  ///< a side, so small that the lens is straight within each

/// The picture cell by cell.
void draw_undistorted(ImDrawList& list,
                      const Camera& camera,
                      void* texture,
                      const PictureMapping& mapping) {
  const auto share = [](int i, int j) -> Vector2d { return Vector2d(i, j) / kCells; };
  std::array<std::array<Vector2d, kCells + 1>, kCells + 1> corners;
  for (int i = 0; i <= kCells; ++i)
    for (int j = 0; j <= kCells; ++j)
      corners[i][j] = to_screen(mapping,
                                share(i, j).cwiseProduct(Vector2d(camera.width, camera.height)) -
                                    Vector2d::Constant(0.5));
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      const Vector2d &a = corners[i][j], &b = corners[i + 1][j];
      const Vector2d &c = corners[i + 1][j + 1], &d = corners[i][j + 1];
      if (!(a + b + c + d).allFinite()) continue;
      list.AddImageQuad(texture,
                        to_imgui(a),
                        to_imgui(b),
                        to_imgui(c),
                        to_imgui(d),
                        to_imgui(share(i, j)),
                        to_imgui(share(i + 1, j)),
                        to_imgui(share(i + 1, j + 1)),
                        to_imgui(share(i, j + 1)));
    }
}

}  // namespace

void draw_picture(ImDrawList& list,
                  const ScreenRect& rect,
                  const Camera& camera,
                  PictureTexture* picture,
                  const PictureMapping& mapping) {
  const ImVec2 low = to_imgui(mapping.origin);
  const ImVec2 high =
      to_imgui(mapping.origin + mapping.scale * Vector2d(camera.width, camera.height));
  draw_surroundings(list, rect, low, high);
  if (picture == nullptr || picture->id() == nullptr)
    return list.AddRectFilled(low, high, imgui_color(Role::raised));
  picture->set_screen_scale(mapping.scale);
  mark_content(list, picture->revision());
  if (mapping.undistorted == nullptr) return list.AddImage(picture->id(), low, high);
  list.AddRectFilled(low, high, imgui_color(Role::background));
  draw_undistorted(list, camera, picture->id(), mapping);
}

void draw_part(ImDrawList& list,
               const Camera& camera,
               const PictureTexture& picture,
               const PictureMapping& mapping,
               const std::array<Vector2d, 3>& triangle_raw_px) {
  constexpr int kPieces = 4;  // a side: small enough that the lens is straight within
  const Vector2d& corner = triangle_raw_px[0];
  const Vector2d u = (triangle_raw_px[1] - corner) / kPieces;
  const Vector2d v = (triangle_raw_px[2] - corner) / kPieces;
  const auto draw = [&](const std::array<Vector2d, 3>& piece) {
    std::array<ImVec2, 3> screen, share;
    for (int k = 0; k < 3; ++k) {
      screen[k] = to_imgui(to_screen(mapping, piece[k]));
      share[k] = to_imgui((piece[k] + Vector2d::Constant(0.5))
                              .cwiseQuotient(Vector2d(camera.width, camera.height)));
    }
    list.AddImageQuad(picture.id(),
                      screen[0],
                      screen[1],
                      screen[2],
                      screen[2],
                      share[0],
                      share[1],
                      share[2],
                      share[2]);
  };
  for (int i = 0; i < kPieces; ++i)
    for (int j = 0; i + j < kPieces; ++j) {
      const Vector2d at = corner + i * u + j * v;
      draw({at, at + u, at + v});
      if (i + j + 1 < kPieces) draw({at + u, at + u + v, at + v});
    }
}

}  // namespace gpo
