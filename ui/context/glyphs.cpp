// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fontconfig/fontconfig.h>
#include <stb/stb_truetype.h>

namespace gpo {
namespace {

constexpr int kSpelled = 6;          // characters of "\u4F60"
constexpr float kCharacter = 0.62F;  // width of a hexadecimal digit [font size]

template <auto destroy>
struct Destroy {
  void operator()(auto* object) const { destroy(object); }
};
using Pattern = std::unique_ptr<FcPattern, Destroy<FcPatternDestroy>>;
using CharSet = std::unique_ptr<FcCharSet, Destroy<FcCharSetDestroy>>;
using FontSet = std::unique_ptr<FcFontSet, Destroy<FcFontSetDestroy>>;

/// Returns the outline fonts of this machine, the most suitable ones first; null if none.
FontSet fonts_for(std::span<const ImWchar> code_points) {
  const CharSet characters(FcCharSetCreate());
  for (const ImWchar code : code_points) FcCharSetAddChar(characters.get(), code);
  const Pattern pattern(FcPatternCreate());
  FcPatternAddString(pattern.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>("sans-serif"));
  FcPatternAddCharSet(pattern.get(), FC_CHARSET, characters.get());
  FcPatternAddBool(pattern.get(), FC_OUTLINE, FcTrue);
  FcConfigSubstitute(nullptr, pattern.get(), FcMatchPattern);
  FcDefaultSubstitute(pattern.get());
  FcResult result = FcResultNoMatch;
  return FontSet(FcFontSort(nullptr, pattern.get(), FcTrue, nullptr, &result));
}

/// Returns whether fontconfig lists one of the code points for the font.
bool may_have(const FcPattern* font, std::span<const ImWchar> code_points) {
  FcCharSet* characters = nullptr;
  if (FcPatternGetCharSet(font, FC_CHARSET, 0, &characters) != FcResultMatch) return false;
  return std::ranges::any_of(
      code_points, [&](ImWchar code) { return FcCharSetHasChar(characters, code) == FcTrue; });
}

/// Returns the code points that Dear ImGui can read from a font; none if it cannot read the file.
std::vector<ImWchar> covered_by(const InstalledFont& font, std::span<const ImWchar> code_points) {
  std::vector<ImWchar> covered;
  if (font.bytes.size() < 12) return covered;
  const auto* data = reinterpret_cast<const unsigned char*>(font.bytes.data());
  const int offset = stbtt_GetFontOffsetForIndex(data, font.index);
  stbtt_fontinfo info;
  if (offset < 0 || stbtt_InitFont(&info, data, offset) == 0) return covered;
  std::ranges::copy_if(code_points, std::back_inserter(covered), [&](ImWchar code) {
    return stbtt_FindGlyphIndex(&info, code) != 0;
  });
  return covered;
}

InstalledFont read_font(const FcPattern* font) {
  InstalledFont read;
  FcChar8* file = nullptr;
  if (FcPatternGetString(font, FC_FILE, 0, &file) != FcResultMatch) return read;
  FcPatternGetInteger(font, FC_INDEX, 0, &read.index);
  read.index &= 0xFFFF;  // the upper bits number a variable font's instances
  std::ifstream stream(reinterpret_cast<const char*>(file), std::ios::binary);
  read.bytes.assign(std::istreambuf_iterator<char>(stream), {});
  return read;
}

/// Returns the mean of the atlas between two columns, in a row [0 to 255].
float texel(const ImFontAtlas& atlas, float x0, float x1, int y) {
  const unsigned char* row =
      atlas.TexPixelsAlpha8 + static_cast<std::ptrdiff_t>(y) * atlas.TexWidth;
  const int first = static_cast<int>(x0), last = std::max(first + 1, static_cast<int>(x1 + 0.5F));
  float sum = 0;
  for (int x = first; x < last; ++x) sum += row[std::min(x, atlas.TexWidth - 1)];
  return sum / static_cast<float>(last - first);
}

/// A part of the atlas [px].
struct Cell {
  int left, top, width, height;
};

/// Copies a glyph of the atlas to the middle of a cell, at the resolution of the screen.
void copy_glyph(ImFontAtlas& atlas, const ImFontGlyph& glyph, const Cell& cell) {
  const auto whole = [](float length) { return static_cast<int>(std::round(length)); };
  const float u0 = glyph.U0 * static_cast<float>(atlas.TexWidth);
  const float u1 = glyph.U1 * static_cast<float>(atlas.TexWidth);
  const int first = whole(glyph.V0 * static_cast<float>(atlas.TexHeight));
  const int above = whole(glyph.Y0), height = whole(glyph.Y1 - glyph.Y0);
  const int columns = std::clamp(whole(glyph.X1 - glyph.X0), 1, cell.width);
  const float step = (u1 - u0) / static_cast<float>(columns);
  const int left = cell.left + (cell.width - columns) / 2;
  for (int y = std::max(0, -above); y < height && above + y < cell.height; ++y)
    for (int x = 0; x < columns; ++x) {
      const float from = u0 + step * static_cast<float>(x);
      const auto row = static_cast<std::ptrdiff_t>(cell.top + above + y);
      atlas.TexPixelsAlpha8[row * atlas.TexWidth + left + x] =
          static_cast<unsigned char>(texel(atlas, from, from + step, first + y));
    }
}

}  // namespace

std::vector<InstalledFont> fonts_with(std::vector<ImWchar> code_points, std::string_view own) {
  std::vector<InstalledFont> found;
  const auto use = [&](InstalledFont font) {
    font.covered = covered_by(font, code_points);
    if (font.covered.empty()) return;
    for (const ImWchar code : font.covered) font.ranges.insert(font.ranges.end(), 2, code);
    font.ranges.push_back(0);
    std::erase_if(code_points,
                  [&](ImWchar code) { return std::ranges::binary_search(font.covered, code); });
    found.push_back(std::move(font));
  };
  if (!code_points.empty()) use({.bytes = std::string(own)});
  if (code_points.empty()) return found;
  const FontSet fonts = fonts_for(code_points);
  for (int i = 0; fonts && i < fonts->nfont && !code_points.empty(); ++i)
    if (may_have(fonts->fonts[i], code_points)) use(read_font(fonts->fonts[i]));
  return found;
}

void reserve_spelled(ImFontAtlas& atlas,
                     ImFont& font,
                     float size_px,
                     std::span<const ImWchar> code_points) {
  const int width = kSpelled * static_cast<int>(std::ceil(kCharacter * size_px));
  const int height = static_cast<int>(std::ceil(size_px));
  for (const ImWchar code : code_points)
    atlas.AddCustomRectFontGlyph(&font, code, width, height, static_cast<float>(width));
}

void draw_spelled(ImFontAtlas& atlas) {
  for (const ImFontAtlasCustomRect& rect : atlas.CustomRects) {
    if (rect.Font == nullptr || !rect.IsPacked()) continue;
    Cell cell{.left = rect.X, .top = rect.Y, .width = rect.Width / kSpelled, .height = rect.Height};
    for (const char character : fmt::format("\\u{:04X}", rect.GlyphID)) {
      copy_glyph(atlas, *rect.Font->FindGlyph(static_cast<ImWchar>(character)), cell);
      cell.left += cell.width;
    }
  }
}

}  // namespace gpo
