// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/theme.h"

#include "ui/context/gui.h"

#include <imgui.h>

namespace gpo {

Theme current_theme() {
  if (ImGui::GetCurrentContext() == nullptr) return Theme::dark;
  const auto* gui = static_cast<const Gui*>(ImGui::GetIO().UserData);
  return gui != nullptr ? gui->theme() : Theme::dark;
}

std::uint32_t color_of(Role role) { return color_of(role, current_theme()); }

std::uint32_t imgui_color(Role role, double alpha) { return imgui_color(color_of(role), alpha); }

}  // namespace gpo
