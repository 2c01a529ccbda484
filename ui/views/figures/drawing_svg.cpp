// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/figures/drawing.h"
#include "ui/views/figures/glyphs.h"

#include <span>

#include <fmt/format.h>

namespace gpo {
namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else {
      result += c;
    }
  }
  return result;
}

std::string points(std::span<const Eigen::Vector2d> line) {
  std::string text;
  for (const Eigen::Vector2d& point : line)
    text += fmt::format("{}{:.2f},{:.2f}", text.empty() ? "" : " ", point.x(), point.y());
  return text;
}

std::string opacity(const char* of, const Ink& ink) {
  return ink.opacity < 1 ? fmt::format(" {}-opacity=\"{:.3g}\"", of, ink.opacity) : "";
}

std::string element(const Fill& fill) {
  return fmt::format("<polygon fill=\"#{:06x}\"{} points=\"{}\"/>\n",
                     fill.ink.rgb,
                     opacity("fill", fill.ink),
                     points(fill.outline));
}

std::string element(const Stroke& stroke) {
  return fmt::format(
      "<polyline fill=\"none\" stroke=\"#{:06x}\"{} stroke-width=\"{:.2f}\" points=\"{}\"/>\n",
      stroke.ink.rgb,
      opacity("stroke", stroke.ink),
      stroke.width,
      points(stroke.line));
}

std::string element(const Text& text) {
  constexpr const char* kAnchors[] = {"start", "middle", "end"};
  const Eigen::Vector2d& at = text.at;
  return fmt::format(
      "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:.2f}\" fill=\"#{:06x}\" "
      "text-anchor=\"{}\"{}{}>{}</text>\n",
      at.x(),
      at.y() + kCapHeight / 2 * text.size,
      text.size,
      text.rgb,
      kAnchors[static_cast<int>(text.anchor)],
      text.bold ? " font-weight=\"600\"" : "",
      text.upwards ? fmt::format(" transform=\"rotate(-90 {:.2f} {:.2f})\"", at.x(), at.y()) : "",
      escaped(text.text));
}

}  // namespace

std::string svg_of(const Drawing& drawing,
                   const std::string& title,
                   const std::string& description) {
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.6g} {1:.6g}\" "
      "width=\"{2:.6g}mm\" height=\"{3:.6g}mm\" font-family=\"Inter, Arial, Helvetica, "
      "sans-serif\" stroke-linejoin=\"round\">\n<title>{4}</title>\n<desc>{5}</desc>\n"
      "<rect width=\"{0:.6g}\" height=\"{1:.6g}\" fill=\"#ffffff\"/>\n",
      drawing.width,
      drawing.height,
      drawing.width * drawing.unit_mm,
      drawing.height * drawing.unit_mm,
      escaped(title),
      escaped(description));
  for (const auto& item : drawing.items)
    svg += std::visit([](const auto& one) { return element(one); }, item);
  return svg + "</svg>\n";
}

}  // namespace gpo
