// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/context/opengl.h"

#include <cstdint>
#include <vector>

#include <imgui.h>

namespace gpo {

/// Marks the content of the texture that is added to the list next. Dear ImGui's lists name only
/// the texture and do not change when another image is uploaded into it.
void mark_content(ImDrawList& list, std::size_t revision);

/// Caches the window's pixels from frame to frame: redraws only the regions where Dear ImGui's
/// lists differ from those of the last frame, then copies all. Needs its context to be current. A
/// screen unit is a pixel.
class WindowImage {
 public:
  /// Draws into the bound framebuffer, over all of it. `data` is unchanged afterwards.
  void show(ImDrawData& data, std::uint32_t background);

  /// Returns the regions that the last call redrew [px], y down.
  const std::vector<cv::Rect>& redrawn() const { return redrawn_; }

 private:
  struct DrawnList {
    std::vector<ImDrawCmd> commands;
    std::vector<ImDrawVert> vertices;
    std::vector<ImDrawIdx> indices;
    cv::Rect bounds;  ///< contains all that it draws
  };
  static DrawnList drawn(const ImDrawList& list);
  static bool same(const DrawnList& drawn, const ImDrawList& list);

  void remember(const ImDrawData& data);
  void redraw(ImDrawData& data, const cv::Rect& part, std::uint32_t background) const;

  std::unique_ptr<Framebuffer> framebuffer_;
  cv::Size size_;
  std::vector<DrawnList> lists_;
  std::vector<cv::Rect> redrawn_;
};

}  // namespace gpo
