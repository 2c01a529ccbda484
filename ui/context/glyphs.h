// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include <imgui.h>

namespace gpo {

/// A font of this machine with some of the requested code points.
struct InstalledFont {
  std::string bytes;             ///< content of the file
  int index = 0;                 ///< position in a collection of fonts
  std::vector<ImWchar> covered;  ///< the requested code points that it has
};

/// Returns installed fonts that have as many of the code points as possible, each in one of them.
std::vector<InstalledFont> installed_fonts(std::vector<ImWchar> code_points);

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
