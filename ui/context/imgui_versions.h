// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

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

/// Whether the number drawn last is a field at the moment, whose text may be half a number.
inline bool number_is_being_typed() {
  return ImGui::TempInputIsActive(ImGui::GetCurrentContext()->LastItemData.ID);
}

/// Menus, combos and what else floats; there is no public call for it.
inline void close_popups() { ImGui::ClosePopupToLevel(0, true); }

}  // namespace gpo
