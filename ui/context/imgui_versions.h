// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <imgui.h>

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

}  // namespace gpo
