// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace gpo {

/// Every color of the views and the panels, 0xRRGGBB. The methods' own are in `methods()`. Data in
/// Okabe-Ito's colors, which people who see few colors tell apart; shape tells them apart too.
namespace palette {

// Data.
constexpr std::uint32_t kInlier = 0x1FCB93;     ///< bluish green, lightened to show on pictures
constexpr std::uint32_t kOutlier = 0xF0503C;    ///< red
constexpr std::uint32_t kResidual = 0xF0E442;   ///< yellow
constexpr std::uint32_t kTruth = 0xA9AEB6;      ///< neutral gray
constexpr std::uint32_t kCubeBase = 0x2BD67B;   ///< green
constexpr std::uint32_t kCubeEdge = 0xE4F3EA;   ///< the other edges: lighter
constexpr std::uint32_t kCubeFace = 0x9FE8C4;   ///< translucent
constexpr std::uint32_t kReference = 0xF0F2F5;  ///< the reference camera's mark
constexpr std::uint32_t kPlane = 0x56B4E9;      ///< sky blue
constexpr std::uint32_t kUncertain = 0xFFF3D6;  ///< warm white
constexpr std::uint32_t kPoint = 0xC9D2DC;      ///< map points
constexpr std::uint32_t kSelected = 0xFFFFFF;   ///< rings around what is picked out
constexpr std::uint32_t kPointedAt = 0x56B4E9;  ///< ... and around what the mouse rests on
constexpr std::uint32_t kRotation = 0xCC79A7;   ///< reddish purple: how fast the camera turns
constexpr std::array<std::uint32_t, 3> kAxes = {0xEF5B50, 0x4CC26B, 0x4A90F0};  ///< x, y, z
/// Stages of an inspection: tracking, RANSAC, rotations, initialization, its optimization.
constexpr std::array<std::uint32_t, 5> kStages = {0x56B4E9, 0xE69F00, 0xCC79A7, 0x009E73, 0xF0E442};

// Surfaces and text, dark to light. Each color stands once: a theme tells them apart by it.
constexpr std::uint32_t kSceneBottom = 0x15181D;
constexpr std::uint32_t kSceneTop = 0x262B33;
constexpr std::uint32_t kBackground = 0x14171B;
constexpr std::uint32_t kPanel = 0x1B1F25;
constexpr std::uint32_t kRaised = 0x272D36;
constexpr std::uint32_t kHovered = 0x343C48;
constexpr std::uint32_t kActive = 0x3F4958;
constexpr std::uint32_t kBorder = 0x323944;
constexpr std::uint32_t kTextDim = 0x98A2B0;
constexpr std::uint32_t kText = 0xE6EAF0;
constexpr std::uint32_t kAccent = 0x5AB6EA;  ///< sky blue: what is chosen or can be dragged
constexpr std::uint32_t kGood = 0x1FCB94;
constexpr std::uint32_t kWarning = 0xE69F01;
constexpr std::uint32_t kBad = 0xF0503D;

// Figures for print, on white; the same in every theme.
constexpr std::uint32_t kInk = 0x1A1D21;
constexpr std::uint32_t kPaperAxis = 0x6B727C;
constexpr std::uint32_t kPaperGrid = 0xE4E7EB;

}  // namespace palette

constexpr double red(std::uint32_t rgb) { return ((rgb >> 16) & 0xFF) / 255.0; }
constexpr double green(std::uint32_t rgb) { return ((rgb >> 8) & 0xFF) / 255.0; }
constexpr double blue(std::uint32_t rgb) { return (rgb & 0xFF) / 255.0; }

/// Of the window: its surfaces, its text, and the data that is drawn light on dark.
enum class Theme { dark, light };
/// What `themed` answers from now on, everywhere: there is one window.
void set_theme(Theme theme);
Theme current_theme();
/// The colors above are those of the dark theme; this is the one that stands for it in the current
/// theme. Colors of methods and most data are the same in both.
std::uint32_t themed(std::uint32_t rgb);

/// Between two colors, 0..1: thin things are drawn dim and opaque, so that depth is right.
inline std::uint32_t mixed_rgb(std::uint32_t a, std::uint32_t b, double share) {
  a = themed(a);
  b = themed(b);
  const auto channel = [&](int shift) {
    const double x = (a >> shift) & 0xFF, y = (b >> shift) & 0xFF;
    return static_cast<std::uint32_t>(std::lround(x + share * (y - x))) << shift;
  };
  return channel(16) | channel(8) | channel(0);
}

/// As Dear ImGui packs a color (IM_COL32), in the current theme. `alpha` in 0..1.
inline std::uint32_t imgui_color(std::uint32_t rgb, double alpha = 1) {
  rgb = themed(rgb);
  return static_cast<std::uint32_t>(alpha * 255.999) << 24 | (rgb & 0xFF) << 16 | (rgb & 0xFF00) |
         ((rgb >> 16) & 0xFF);
}

}  // namespace gpo
