// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/context/framebuffer.h"

#include <cstdint>
#include <memory>
#include <vector>

#include <imgui.h>
#include <opencv2/core.hpp>

namespace gpo {

/// To be called before a texture is added to the list: says which content of it is meant. Dear
/// ImGui's lists name a texture, and stay the same when another picture is brought into it.
void mark_content(ImDrawList& list, std::size_t revision);

/// The picture of the window, kept from frame to frame: only where Dear ImGui's lists differ from
/// those of the last frame is it drawn anew, and then it is copied. What is drawn is compared, not
/// what it was drawn from, so that nobody has to say what has changed, textures excepted
/// (`mark_content`). A screen unit is a pixel. Needs its context to be current.
class WindowImage {
 public:
  /// Into the framebuffer that is bound, over all of it. `data` is what it was afterwards.
  void show(ImDrawData& data, std::uint32_t background_rgb);

  /// What the last call drew anew [px], y down; empty where nothing had changed.
  const std::vector<cv::Rect>& redrawn() const { return redrawn_; }

 private:
  /// What Dear ImGui wanted to be drawn for one of its windows.
  struct DrawnList {
    std::vector<ImDrawCmd> commands;
    std::vector<ImDrawVert> vertices;
    std::vector<ImDrawIdx> indices;
    cv::Rect bounds;  ///< nothing is drawn outside of it
  };
  static DrawnList drawn(const ImDrawList& list);
  static bool same(const DrawnList& drawn, const ImDrawList& list);

  void remember(const ImDrawData& data);
  void redraw(ImDrawData& data, const cv::Rect& part, std::uint32_t background_rgb) const;

  std::unique_ptr<Framebuffer> framebuffer_;
  cv::Size size_;
  std::vector<DrawnList> lists_;
  std::vector<cv::Rect> redrawn_;
};

}  // namespace gpo
