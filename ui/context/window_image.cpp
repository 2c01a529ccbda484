// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/window_image.h"

#include "ui/context/imgui_versions.h"
#include "ui/look/palette.h"

#include <algorithm>
#include <cstring>

#include <GL/glew.h>
#include <backends/imgui_impl_opengl3.h>

namespace gpo {
namespace {

void draws_nothing(const ImDrawList* /*list*/, const ImDrawCmd* /*command*/) {}

template <class T>
bool same_items(const std::vector<T>& a, const ImVector<T>& b) {
  return static_cast<int>(a.size()) == b.Size &&
         (a.empty() || std::memcmp(a.data(), b.Data, a.size() * sizeof(T)) == 0);
}

bool same_rectangle(const ImVec4& a, const ImVec4& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
}

bool same_command(const ImDrawCmd& a, const ImDrawCmd& b) {
  return same_rectangle(a.ClipRect, b.ClipRect) && a.TextureId == b.TextureId &&
         a.VtxOffset == b.VtxOffset && a.IdxOffset == b.IdxOffset && a.ElemCount == b.ElemCount &&
         a.UserCallback == b.UserCallback && a.UserCallbackData == b.UserCallbackData;
}

/// Rounds outwards to whole pixels; empty if the corners are not in order.
cv::Rect outer_rect(float x0, float y0, float x1, float y1) {
  const cv::Point low(static_cast<int>(std::floor(x0)), static_cast<int>(std::floor(y0)));
  const cv::Point high(static_cast<int>(std::ceil(x1)), static_cast<int>(std::ceil(y1)));
  return high.x > low.x && high.y > low.y ? cv::Rect(low, high) : cv::Rect();
}

cv::Rect bounds_of(const ImDrawList& list) {
  if (list.VtxBuffer.empty()) return {};
  ImVec2 low = list.VtxBuffer[0].pos, high = low;
  for (const ImDrawVert& vertex : list.VtxBuffer) {
    low = {std::min(low.x, vertex.pos.x), std::min(low.y, vertex.pos.y)};
    high = {std::max(high.x, vertex.pos.x), std::max(high.y, vertex.pos.y)};
  }
  cv::Rect clips;
  for (const ImDrawCmd& command : list.CmdBuffer) {
    const ImVec4& clip = command.ClipRect;
    if (command.ElemCount > 0) clips |= outer_rect(clip.x, clip.y, clip.z, clip.w);
  }
  return clips & outer_rect(low.x, low.y, high.x, high.y);
}

/// Merges overlapping rectangles, so that no pixel is drawn twice.
void add(std::vector<cv::Rect>& rects, cv::Rect rect) {
  if (rect.empty()) return;
  for (auto other = rects.begin(); other != rects.end();) {
    if ((*other & rect).empty()) {
      ++other;
    } else {
      rect |= *other;
      rects.erase(other);
      other = rects.begin();
    }
  }
  rects.push_back(rect);
}

void clear(const cv::Rect& part, int height, std::uint32_t rgb) {
  glEnable(GL_SCISSOR_TEST);
  glScissor(part.x, height - part.br().y, part.width, part.height);
  const ImVec4 color = ImGui::ColorConvertU32ToFloat4(imgui_color(rgb));
  glClearColor(color.x, color.y, color.z, 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

}  // namespace

void mark_content(ImDrawList& list, std::size_t revision) {
  // Never read as an address. NOLINTNEXTLINE(performance-no-int-to-ptr)
  list.AddCallback(draws_nothing, reinterpret_cast<void*>(revision));
}

WindowImage::DrawnList WindowImage::drawn(const ImDrawList& list) {
  return {{list.CmdBuffer.begin(), list.CmdBuffer.end()},
          {list.VtxBuffer.begin(), list.VtxBuffer.end()},
          {list.IdxBuffer.begin(), list.IdxBuffer.end()},
          bounds_of(list)};
}

bool WindowImage::same(const DrawnList& drawn, const ImDrawList& list) {
  return std::ranges::equal(drawn.commands, list.CmdBuffer, same_command) &&
         same_items(drawn.vertices, list.VtxBuffer) && same_items(drawn.indices, list.IdxBuffer);
}

/// Collects the regions where the lists differ from those of the last frame.
void WindowImage::remember(const ImDrawData& data) {
  const auto count = static_cast<std::size_t>(data.CmdListsCount);
  for (std::size_t i = count; i < lists_.size(); ++i) add(redrawn_, lists_[i].bounds);
  lists_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    if (same(lists_[i], list)) continue;
    add(redrawn_, lists_[i].bounds);
    lists_[i] = drawn(list);
    add(redrawn_, lists_[i].bounds);
  }
}

/// Redraws a region from all lists in it: they cover each other.
void WindowImage::redraw(ImDrawData& data, const cv::Rect& part, std::uint32_t background) const {
  clear(part, size_.height, background);
  std::vector<ImDrawList*> lists;
  for (std::size_t i = 0; i < lists_.size(); ++i) {
    if ((lists_[i].bounds & part).empty()) continue;
    lists.push_back(data.CmdLists[i]);
    for (ImDrawCmd& command : data.CmdLists[i]->CmdBuffer) {
      ImVec4& clip = command.ClipRect;
      clip = {std::max(clip.x, static_cast<float>(part.x)),
              std::max(clip.y, static_cast<float>(part.y)),
              std::min(clip.z, static_cast<float>(part.br().x)),
              std::min(clip.w, static_cast<float>(part.br().y))};
    }
  }
  ImDrawData of_part = data;
  set_draw_lists(of_part, lists);
  ImGui_ImplOpenGL3_RenderDrawData(&of_part);
  for (std::size_t i = 0; i < lists_.size(); ++i)
    std::ranges::copy(lists_[i].commands, data.CmdLists[i]->CmdBuffer.begin());
}

void WindowImage::show(ImDrawData& data, std::uint32_t background) {
  GLint target = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
  redrawn_.clear();
  remember(data);
  const cv::Size size(static_cast<int>(data.DisplaySize.x), static_cast<int>(data.DisplaySize.y));
  const cv::Rect whole({0, 0}, size);
  if (!framebuffer_ || size != size_) {
    framebuffer_ = std::make_unique<Framebuffer>(size.width, size.height);
    size_ = size;
    redrawn_ = {whole};
  }
  framebuffer_->bind();
  for (cv::Rect& part : redrawn_) {
    part &= whole;
    if (!part.empty()) redraw(data, part, background);
  }
  framebuffer_->copy_to(static_cast<unsigned>(target));
}

}  // namespace gpo
