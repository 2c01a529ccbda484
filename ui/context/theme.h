// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/palette.h"

namespace gpo {

/// Returns the theme of the current Dear ImGui context (`Gui::set_theme`); dark if there is none.
/// Like fonts and style it is a property of the context, so that draw functions need no parameter.
Theme current_theme();

std::uint32_t color_of(Role role);  ///< In the current theme.
/// Packed as in Dear ImGui. `alpha` in 0..1.
std::uint32_t imgui_color(Role role, double alpha = 1);

}  // namespace gpo
