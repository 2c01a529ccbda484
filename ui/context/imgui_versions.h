// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>
#include <imgui_internal.h>

// Where the versions of Dear ImGui that the program is built with differ, 1.86 (Debian 12) to
// 1.90.1 (Debian 13).
namespace gpo {

/// Makes `data` a drawing of these lists; they must outlive it.
inline void set_draw_lists(ImDrawData& data, std::vector<ImDrawList*>& lists) {
#if IMGUI_VERSION_NUM < 18980
  data.CmdLists = lists.data();
#else
  data.CmdLists.resize(0);
  for (ImDrawList* list : lists) data.CmdLists.push_back(list);
#endif
  data.CmdListsCount = static_cast<int>(lists.size());
}

/// Where the pointer is [screen units]; the older one asks the window itself.
inline void hand_pointer_to_imgui([[maybe_unused]] GLFWwindow* window,
                                  [[maybe_unused]] double x,
                                  [[maybe_unused]] double y) {
#if IMGUI_VERSION_NUM >= 18700
  ImGui_ImplGlfw_CursorPosCallback(window, x, y);
#endif
}

/// A key as the window told of it. What is held with it is what was held then: the newer one asks
/// the keyboard as it is now, when the next Ctrl may be down already.
inline void hand_key_to_imgui(
    GLFWwindow* window, int key, int scancode, int action, int modifiers) {
  ImGui_ImplGlfw_KeyCallback(window, key, scancode, action, modifiers);
#if IMGUI_VERSION_NUM >= 18900
  const auto tell = [&](ImGuiKey of, int modifier, int left, int right) {
    const bool itself = key == left || key == right;  // GLFW tells what was held before
    ImGui::GetIO().AddKeyEvent(of, itself ? action != GLFW_RELEASE : (modifiers & modifier) != 0);
  };
  tell(ImGuiMod_Ctrl, GLFW_MOD_CONTROL, GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
  tell(ImGuiMod_Shift, GLFW_MOD_SHIFT, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
  tell(ImGuiMod_Alt, GLFW_MOD_ALT, GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
  tell(ImGuiMod_Super, GLFW_MOD_SUPER, GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER);
#endif
}

/// Events are handed on in the frame that they are for (`InputQueue`): the newer one is not to
/// spread them over frames once more.
inline void take_events_as_they_come() {
#if IMGUI_VERSION_NUM >= 18700
  ImGui::GetIO().ConfigInputTrickleEventQueue = false;
#endif
}

/// Whether the number drawn last is a field at the moment, whose text may be half a number.
inline bool number_is_being_typed() {
  return ImGui::TempInputIsActive(ImGui::GetCurrentContext()->LastItemData.ID);
}

/// Menus, combos and what else floats; there is no public call for it.
inline void close_popups() { ImGui::ClosePopupToLevel(0, true); }

}  // namespace gpo
