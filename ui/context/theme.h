// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/palette.h"

#include <cstdint>

namespace gpo {

/// The theme that the current Dear ImGui context is drawn in (`Gui::set_theme`); dark where there
/// is none. It belongs to the context as its fonts and its style do: there is one for all that is
/// drawn into it, and everything that draws would have to be handed it.
Theme current_theme();

/// In the current theme.
std::uint32_t color_of(Role role);
/// As Dear ImGui packs it. `alpha` in 0..1.
std::uint32_t imgui_color(Role role, double alpha = 1);

}  // namespace gpo
