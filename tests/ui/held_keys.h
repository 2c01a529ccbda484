// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <imgui.h>

namespace gpo::test {

/// Holds or lets go of Control and Shift, from the next frame on. Dear ImGui reads what happened to
/// keys since 1.87, and where they stand before.
inline void hold(bool control, bool shift) {
  ImGuiIO& io = ImGui::GetIO();
#if IMGUI_VERSION_NUM < 18700
  io.KeyCtrl = control;
  io.KeyShift = shift;
#else
  io.AddKeyEvent(ImGuiMod_Ctrl, control);
  io.AddKeyEvent(ImGuiMod_Shift, shift);
#endif
}

}  // namespace gpo::test
