// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/figures/drawing.h"
#include "ui/views/figures/glyphs.h"

#include <map>
#include <span>
#include <stdexcept>

#include <fmt/format.h>
#include <zlib.h>

namespace gpo {
namespace {

using Eigen::Vector2d;

/// The page's content, in the drawing's units: the first operator turns them to points, y up.
class Page {
 public:
  explicit Page(const Drawing& drawing) {
    const double points = drawing.unit_mm / 25.4 * 72;
    content_ = fmt::format(
        "{0:.6f} 0 0 {1:.6f} 0 {2:.4f} cm 1 j\n", points, -points, drawing.height * points);
    for (const auto& item : drawing.items) std::visit([this](const auto& one) { add(one); }, item);
  }

  const std::string& content() const { return content_; }
  /// "/G1 << /ca 0.18 /CA 0.18 >>" for each.
  std::string opacities() const {
    std::string text;
    for (const auto& [opacity, name] : names_)
      text += fmt::format("/{0} << /ca {1:.3f} /CA {1:.3f} >> ", name, opacity);
    return text;
  }

 private:
  void add(const Fill& fill) {
    set(fill.ink, "rg");
    path(fill.outline);
    content_ += "f\n";
  }

  void add(const Stroke& stroke) {
    set(stroke.ink, "RG");
    content_ += fmt::format("{:.3f} w ", stroke.width);
    path(stroke.line);
    content_ += "S\n";
  }

  void add(const Text& text) {
    set({text.rgb}, "rg");
    for (const OutlinePiece& piece : outlines_of(text)) {
      const auto& [a, b, end] = piece.points;
      if (piece.kind == OutlinePiece::Kind::cubic) {
        content_ += point(a) + point(b) + point(end) + "c ";
      } else {
        content_ += point(end) + (piece.kind == OutlinePiece::Kind::move ? "m " : "l ");
      }
    }
    content_ += "f*\n";
  }

  void set(const Ink& ink, const char* operation) {
    const std::string fresh = fmt::format("G{}", names_.size());
    const std::string& name = names_.emplace(ink.opacity, fresh).first->second;
    content_ += fmt::format("/{} gs {:.3f} {:.3f} {:.3f} {} ",
                            name,
                            (ink.rgb >> 16 & 0xFF) / 255.0,
                            (ink.rgb >> 8 & 0xFF) / 255.0,
                            (ink.rgb & 0xFF) / 255.0,
                            operation);
  }

  void path(std::span<const Vector2d> line) {
    const char* operation = "m ";
    for (const Vector2d& one : line) {
      content_ += point(one) + operation;
      operation = "l ";
    }
  }

  static std::string point(const Vector2d& p) {
    return fmt::format("{:.3f} {:.3f} ", p.x(), p.y());
  }

  std::string content_;
  std::map<double, std::string> names_;  ///< of the graphics states, by their opacity
};

std::string compressed(const std::string& text) {
  uLongf size = compressBound(static_cast<uLong>(text.size()));
  std::string bytes(size, '\0');
  const auto* from = reinterpret_cast<const Bytef*>(text.data());
  auto* to = reinterpret_cast<Bytef*>(bytes.data());
  if (compress2(to, &size, from, static_cast<uLong>(text.size()), Z_BEST_COMPRESSION) != Z_OK)
    throw std::runtime_error("zlib does not compress");
  bytes.resize(size);
  return bytes;
}

}  // namespace

std::string pdf_of(const Drawing& drawing) {
  const Page page(drawing);
  const std::string content = compressed(page.content());
  const double points = drawing.unit_mm / 25.4 * 72;
  const std::vector<std::string> objects = {
      "<< /Type /Catalog /Pages 2 0 R >>",
      "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
      fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:.4f} {:.4f}] /Contents 4 0 R "
                  "/Resources << /ExtGState << {}>> >> >>",
                  drawing.width * points,
                  drawing.height * points,
                  page.opacities()),
      fmt::format("<< /Length {} /Filter /FlateDecode >>\nstream\n", content.size()) + content +
          "\nendstream"};
  std::string pdf = "%PDF-1.4\n%\xE2\xE3\xCF\xD3\n";  // the second line says that it is binary
  std::string table = fmt::format("xref\n0 {}\n0000000000 65535 f \n", objects.size() + 1);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    table += fmt::format("{:010} 00000 n \n", pdf.size());
    pdf += fmt::format("{} 0 obj\n", i + 1) + objects[i] + "\nendobj\n";
  }
  const std::size_t begin = pdf.size();
  return pdf + table +
         fmt::format("trailer\n<< /Size {} /Root 1 0 R >>\nstartxref\n{}\n%%EOF\n",
                     objects.size() + 1,
                     begin);
}

}  // namespace gpo
