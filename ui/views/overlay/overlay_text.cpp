// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/overlay/overlay_text.h"

#include <cmath>

#include <imgui.h>

namespace gpo {

using Eigen::Vector2d;

void write_text(
    ImDrawList& list, Font which, const Vector2d& at, const std::string& text, std::uint32_t rgb) {
  const ImFont* f = font(which);
  const ImVec2 place(std::round(static_cast<float>(at.x())),
                     std::round(static_cast<float>(at.y())));
  list.AddText(f, f->FontSize, place, imgui_color(rgb), text.c_str());
}

double text_width(Font which, const std::string& text) {
  const ImFont* f = font(which);
  return f->CalcTextSizeA(f->FontSize, 1e6F, 0, text.c_str()).x;
}

std::string fitting_text(Font which, std::initializer_list<std::string> texts, double width) {
  for (const std::string& text : texts)
    if (text_width(which, text) <= width) return text;
  std::string text = *std::prev(texts.end());
  const auto cut = [&] {
    do text.pop_back();
    while (!text.empty() && (text.back() & 0xC0) == 0x80);
  };
  while (!text.empty() && text_width(which, text + "\u2026") > width) cut();
  return text + "\u2026";
}

}  // namespace gpo
