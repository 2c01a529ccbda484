// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/vtk_text.h"

#include "ui/context/gui_style.h"
#include "ui/context/memory_file.h"
#include "ui/look/palette.h"

#include <cmath>
#include <string>

#include <vtkTextProperty.h>

namespace gpo {
namespace {

/// VTK reads fonts by a file's name only, and again whenever it wants to: these stay.
std::string font_path(Weight weight) {
  static const MemoryFile regular(regular_font()), bold(bold_font());
  return (weight == Weight::bold ? bold : regular).path();
}

}  // namespace

void set_font(vtkTextProperty& property, Weight weight, double size_px, std::uint32_t rgb) {
  property.SetFontFamily(VTK_FONT_FILE);
  property.SetFontFile(font_path(weight).c_str());
  property.SetBold(0);
  property.SetItalic(0);
  property.SetShadow(0);
  property.SetFontSize(static_cast<int>(std::lround(size_px)));
  property.SetColor(red(rgb), green(rgb), blue(rgb));
}

}  // namespace gpo
