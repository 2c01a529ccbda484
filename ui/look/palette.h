// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

namespace gpo {

/// Meaning of a color in views and panels. The methods' colors are in `methods()`, the same in
/// every theme. Data have Okabe and Ito's colors, which color-blind people can distinguish.
// clang-format off
enum class Role {
  // Data.
  inlier, outlier, residual, truth,
  cube_base, cube_edge, cube_face,
  reference,  ///< the reference camera's mark
  plane, uncertain, map_point,
  selected,    ///< rings around picked tracks
  pointed_at,  ///< rings around the item under the mouse
  rotation,    ///< angular rate
  axis_x, axis_y, axis_z,
  gravity,  ///< up direction and horizon
  // Stages of an inspection.
  tracking, ransac, rotations, initialization, optimization,
  // Surfaces and text.
  scene_bottom, scene_top, background, panel, raised, hovered, active, border, text_dim, text,
  accent,  ///< chosen or draggable items
  good, warning, bad,
};
// clang-format on

/// Colors of the window's surfaces and text, and of data drawn light on dark.
enum class Theme { dark, light };

std::uint32_t color_of(Role role, Theme theme);  ///< 0xRRGGBB.

/// Colors of figures for print, on white; the same in every theme.
namespace palette {
constexpr std::uint32_t kInk = 0x1A1D21;
constexpr std::uint32_t kPaperAxis = 0x6B727C;
constexpr std::uint32_t kPaperGrid = 0xE4E7EB;
}  // namespace palette

constexpr double red(std::uint32_t rgb) { return ((rgb >> 16) & 0xFF) / 255.0; }
constexpr double green(std::uint32_t rgb) { return ((rgb >> 8) & 0xFF) / 255.0; }
constexpr double blue(std::uint32_t rgb) { return (rgb & 0xFF) / 255.0; }

/// Mixes two colors, `share` 0..1. Thin lines are dimmed this way, opaque, so that depth is right.
inline std::uint32_t mixed_rgb(std::uint32_t a, std::uint32_t b, double share) {
  const auto channel = [&](int shift) {
    const double x = (a >> shift) & 0xFF, y = (b >> shift) & 0xFF;
    return static_cast<std::uint32_t>(std::lround(x + share * (y - x))) << shift;
  };
  return channel(16) | channel(8) | channel(0);
}

/// Packs a color as Dear ImGui does (IM_COL32). `alpha` in 0..1.
inline std::uint32_t imgui_color(std::uint32_t rgb, double alpha = 1) {
  return static_cast<std::uint32_t>(alpha * 255.999) << 24 | (rgb & 0xFF) << 16 | (rgb & 0xFF00) |
         ((rgb >> 16) & 0xFF);
}

}  // namespace gpo
