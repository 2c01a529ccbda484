// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>
#include <imgui_internal.h>

// Differences between the supported versions of Dear ImGui, 1.86 (Debian 12) to 1.90.1 (Debian 13).
namespace gpo {

/// Sets the lists of `data`; they must outlive it.
inline void set_draw_lists(ImDrawData& data, std::vector<ImDrawList*>& lists) {
#if IMGUI_VERSION_NUM < 18980
  data.CmdLists = lists.data();
#else
  data.CmdLists.resize(0);
  for (ImDrawList* list : lists) data.CmdLists.push_back(list);
#endif
  data.CmdListsCount = static_cast<int>(lists.size());
}

/// Passes the pointer's position [screen units]; 1.86 queries the window itself.
inline void hand_pointer_to_imgui([[maybe_unused]] GLFWwindow* window,
                                  [[maybe_unused]] double x,
                                  [[maybe_unused]] double y) {
#if IMGUI_VERSION_NUM >= 18700
  ImGui_ImplGlfw_CursorPosCallback(window, x, y);
#endif
}

/// Returns the key to pass to Dear ImGui; 1.86 does not know the keyboard layout.
inline int key_for_imgui(int place, [[maybe_unused]] int layout_key) {
#if IMGUI_VERSION_NUM < 18700
  const bool letter = layout_key >= GLFW_KEY_A && layout_key <= GLFW_KEY_Z;
  // The place of a letter may have a sign in the layout, whose key is unused.
  const bool other = place >= GLFW_KEY_A && place <= GLFW_KEY_Z;
  if (letter || other) return layout_key;
#endif
  return place;
}

/// Passes a key event with its own modifiers. Dear ImGui from 1.89 on would query the keyboard's
/// present state, in which the next Ctrl may already be down.
inline void hand_key_to_imgui(
    GLFWwindow* window, int key, int scancode, int action, int modifiers) {
  ImGui_ImplGlfw_KeyCallback(window, key, scancode, action, modifiers);
#if IMGUI_VERSION_NUM >= 18900
  const auto pass = [&](ImGuiKey name, int modifier, int left, int right) {
    const bool itself = key == left || key == right;  // `modifiers` are those before the event
    ImGui::GetIO().AddKeyEvent(name, itself ? action != GLFW_RELEASE : (modifiers & modifier) != 0);
  };
  pass(ImGuiMod_Ctrl, GLFW_MOD_CONTROL, GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
  pass(ImGuiMod_Shift, GLFW_MOD_SHIFT, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
  pass(ImGuiMod_Alt, GLFW_MOD_ALT, GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
  pass(ImGuiMod_Super, GLFW_MOD_SUPER, GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER);
#endif
}

/// Keeps Dear ImGui from spreading events over frames: `InputQueue` already does.
inline void take_events_as_they_come() {
#if IMGUI_VERSION_NUM >= 18700
  ImGui::GetIO().ConfigInputTrickleEventQueue = false;
#endif
}

/// Returns true if the last number widget is being edited as text, maybe an incomplete number.
inline bool number_is_being_typed() {
  return ImGui::TempInputIsActive(ImGui::GetCurrentContext()->LastItemData.ID);
}

/// Returns the last item; 1.86 has no public function for it.
inline ImGuiID last_item() { return ImGui::GetCurrentContext()->LastItemData.ID; }

/// Closes menus, combos and other popups; there is no public function for it.
inline void close_popups() { ImGui::ClosePopupToLevel(0, true); }

}  // namespace gpo
