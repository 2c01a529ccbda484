// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/views/palette.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

void draw_progress(const WorkerStatus& worker, float scale) {
  const std::string stage = worker.stage.empty() ? "waiting" : worker.stage;
  const std::string text =
      worker.of > 0 ? fmt::format("{} {}/{}", stage, worker.done, worker.of) : stage;
  ImGui::TextUnformatted(text.c_str());
  if (worker.of > 0) {
    // At a fixed place: a bar that moves with its text is hard to read.
    ImGui::SameLine(190 * scale);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size(140 * scale, std::round(8 * scale));
    const float y = std::round(at.y + (ImGui::GetTextLineHeight() - size.y) / 2);
    const float done = std::clamp(static_cast<float>(worker.done) / worker.of, 0.0F, 1.0F);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(
        {at.x, y}, {at.x + size.x, y + size.y}, imgui_color(palette::kRaised), size.y / 2);
    list.AddRectFilled({at.x, y},
                       {at.x + std::max(size.y, size.x * done), y + size.y},
                       imgui_color(palette::kAccent),
                       size.y / 2);
    ImGui::Dummy({size.x, ImGui::GetTextLineHeight()});
    ImGui::SameLine();
  } else {
    ImGui::SameLine(190 * scale);
  }
  ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(palette::kTextDim));
  ImGui::TextUnformatted("Esc cancels");
  ImGui::PopStyleColor();
}

}  // namespace

void status_line(const PanelInput& input, const Rectangle& place) {
  const float s = input.scale;
  const float padding = std::round((place.height - ImGui::GetTextLineHeight()) / 2);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_color(palette::kBackground));
  {
    const PanelScope panel("status", place, {12 * s, padding});
    const float right = place.width - 12 * s;
    const bool error = !input.worker.error.empty();
    const std::string& message = error ? input.worker.error : input.state.message;
    const std::uint32_t color = error ? palette::kBad : palette::kTextDim;
    if (input.worker.busy || input.writing != nullptr) {
      draw_progress(input.writing != nullptr ? *input.writing : input.worker, s);
      const float left = 450 * s;
      ImGui::SameLine(std::max(left, right - ImGui::CalcTextSize(message.c_str()).x));
      clipped_text(message, right - left, color);
    } else {
      clipped_text(message.empty() ? "F1 lists the keys" : message, right - 12 * s, color);
    }
  }
  ImGui::PopStyleColor();
}

}  // namespace gpo
