// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/figures/glyphs.h"

#include "ui/context/gui_style.h"

#include <sstream>
#include <stdexcept>
#include <string_view>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

namespace gpo {
namespace {

using Eigen::Vector2d;
using Kind = OutlinePiece::Kind;

/// A font of the program's, without hints: one shape at all sizes.
class Typeface {
 public:
  explicit Typeface(bool bold) {
    const std::string_view font = bold ? bold_font() : regular_font();
    if (FT_Init_FreeType(&library_) != 0) throw std::runtime_error("FreeType does not start");
    const auto* bytes = reinterpret_cast<const FT_Byte*>(font.data());
    if (FT_New_Memory_Face(library_, bytes, static_cast<FT_Long>(font.size()), 0, &face_) != 0) {
      FT_Done_FreeType(library_);
      throw std::runtime_error("FreeType does not read the program's font");
    }
  }
  ~Typeface() { FT_Done_FreeType(library_); }  // and its face
  Typeface(const Typeface&) = delete;
  Typeface& operator=(const Typeface&) = delete;

  double units_per_em() const { return face_->units_per_EM; }

  /// In the font's units.
  const FT_GlyphSlotRec_& glyph(std::uint32_t code) {
    if (FT_Load_Char(face_, code, FT_LOAD_NO_SCALE) != 0)
      throw std::runtime_error("the program's font has a broken glyph");
    return *face_->glyph;
  }

 private:
  FT_Library library_ = nullptr;
  FT_Face face_ = nullptr;
};

/// Of UTF-8; what is none becomes the replacement character.
std::vector<std::uint32_t> code_points(const std::string& text) {
  std::vector<std::uint32_t> codes;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i++]);
    int more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
    std::uint32_t code = more == 0 ? lead : lead & (0x3FU >> more);
    for (; more > 0 && i < text.size() && (text[i] & 0xC0) == 0x80; --more)
      code = code << 6 | (static_cast<unsigned char>(text[i++]) & 0x3FU);
    codes.push_back(more > 0 || (lead >= 0x80 && lead < 0xC0) ? 0xFFFD : code);
  }
  return codes;
}

/// Where FreeType's decomposition of an outline goes.
struct Pen {
  std::vector<OutlinePiece>& pieces;
  const Text& text;
  double scale;
  double x, y;  ///< of the glyph's origin from `text.at`, y down
  Vector2d last = Vector2d::Zero();

  Vector2d place(const FT_Vector& v) const {
    const Vector2d p(x + scale * static_cast<double>(v.x), y - scale * static_cast<double>(v.y));
    return text.at + (text.upwards ? Vector2d(p.y(), -p.x()) : p);
  }
  void add(Kind kind, const Vector2d& a, const Vector2d& b, const Vector2d& end) {
    pieces.push_back({kind, {a, b, end}});
    last = end;
  }
};

FT_Outline_Funcs decomposition() {
  FT_Outline_Funcs functions{};
  functions.move_to = [](const FT_Vector* to, void* pen) {
    auto& p = *static_cast<Pen*>(pen);
    const Vector2d end = p.place(*to);
    p.add(Kind::move, end, end, end);
    return 0;
  };
  functions.line_to = [](const FT_Vector* to, void* pen) {
    auto& p = *static_cast<Pen*>(pen);
    const Vector2d end = p.place(*to);
    p.add(Kind::line, end, end, end);
    return 0;
  };
  functions.conic_to = [](const FT_Vector* control, const FT_Vector* to, void* pen) {
    auto& p = *static_cast<Pen*>(pen);
    const Vector2d c = p.place(*control), end = p.place(*to);
    p.add(Kind::cubic, p.last + 2.0 / 3 * (c - p.last), end + 2.0 / 3 * (c - end), end);
    return 0;
  };
  functions.cubic_to = [](const FT_Vector* a, const FT_Vector* b, const FT_Vector* to, void* pen) {
    auto& p = *static_cast<Pen*>(pen);
    p.add(Kind::cubic, p.place(*a), p.place(*b), p.place(*to));
    return 0;
  };
  return functions;
}

double width_of(Typeface& face, const std::string& text, double size) {
  double width = 0;
  for (const std::uint32_t code : code_points(text))
    width += static_cast<double>(face.glyph(code).metrics.horiAdvance);
  return width * size / face.units_per_em();
}

}  // namespace

std::vector<OutlinePiece> outlines_of(const Text& text) {
  static const FT_Outline_Funcs kDecomposition = decomposition();
  Typeface face(text.bold);
  const double scale = text.size / face.units_per_em();
  const double share = text.anchor == Anchor::begin ? 0 : text.anchor == Anchor::middle ? 0.5 : 1;
  std::vector<OutlinePiece> pieces;
  Pen pen{pieces,
          text,
          scale,
          -share * width_of(face, text.text, text.size),
          kCapHeight / 2 * text.size};
  for (const std::uint32_t code : code_points(text.text)) {
    FT_Outline outline = face.glyph(code).outline;
    FT_Outline_Decompose(&outline, &kDecomposition, &pen);
    pen.x += scale * static_cast<double>(face.glyph(code).metrics.horiAdvance);
  }
  return pieces;
}

double width_of(const std::string& text, double size, bool bold) {
  Typeface face(bold);
  return width_of(face, text, size);
}

std::vector<std::string> wrapped(const std::string& text, double size, bool bold, double room) {
  Typeface face(bold);
  std::vector<std::string> lines;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const bool fits = !lines.empty() && width_of(face, lines.back() + " " + word, size) <= room;
    if (fits) {
      lines.back() += " " + word;
    } else {
      lines.push_back(word);
    }
  }
  return lines;
}

}  // namespace gpo
