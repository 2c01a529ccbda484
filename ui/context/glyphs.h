// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <imgui.h>

namespace gpo {

/// A font with some of the requested code points.
struct InstalledFont {
  std::string bytes;                  ///< content of its file
  int index = 0;                      ///< position in a collection of fonts
  std::vector<ImWchar> covered = {};  ///< the requested code points that it has, ascending
};

/// Returns fonts that have as many of the code points (ascending) as possible, each in one of them:
/// the program's `own` one, then those of this machine.
std::vector<InstalledFont> fonts_with(std::vector<ImWchar> code_points, std::string_view own = {});

/// Returns ranges of Dear ImGui, each of one code point, and a 0 at the end.
std::vector<ImWchar> ranges_of(std::span<const ImWchar> code_points);

/// Reserves glyphs of a font for code points that no font has. Call it before the atlas is built.
void reserve_spelled(ImFontAtlas& atlas,
                     ImFont& font,
                     float size_px,
                     std::span<const ImWchar> code_points);
/// Draws all reserved glyphs as "\u4F60", in their own font. Call it after the atlas is built.
void draw_spelled(ImFontAtlas& atlas);

}  // namespace gpo
