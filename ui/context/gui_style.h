// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/palette.h"

#include <string_view>

namespace gpo {

/// The two font files that the program carries with it, OpenType.
std::string_view regular_font();
std::string_view bold_font();

/// Colors, paddings and corners of the program, in the current Dear ImGui context.
void apply_style(float scale, Theme theme);

/// The fonts of `Font`, in its order, from the bytes that the program carries.
void load_fonts(float scale);

}  // namespace gpo
