// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace gpo {
namespace {

/// What is being done, the most waited for first; nothing where all is done.
std::optional<JobStatus> current_work(const PanelInput& input) {
  if (input.writing != nullptr) return *input.writing;
  if (input.worker.busy) return input.worker;
  if (input.survey.busy())
    return JobStatus{true, "comparing", input.survey.done, input.survey.of, ""};
  if (input.scan != nullptr && input.scan->busy())
    return JobStatus{true, "scanning", input.scan->done, input.scan->of, ""};
  return std::nullopt;
}

std::uint32_t color_of(Severity severity) {
  if (severity == Severity::error) return gpo::color_of(Role::bad);
  return gpo::color_of(severity == Severity::warning ? Role::warning : Role::text_dim);
}

void draw_bar(float done, float scale) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size(140 * scale, std::round(8 * scale));
  const float y = std::round(at.y + (ImGui::GetTextLineHeight() - size.y) / 2);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({at.x, y}, {at.x + size.x, y + size.y}, imgui_color(Role::raised), size.y / 2);
  list.AddRectFilled({at.x, y},
                     {at.x + std::max(size.y, size.x * std::clamp(done, 0.0F, 1.0F)), y + size.y},
                     imgui_color(Role::accent),
                     size.y / 2);
  ImGui::Dummy({size.x, ImGui::GetTextLineHeight()});
  ImGui::SameLine();
}

/// Returns where its text ends [px from the panel's left edge].
float draw_progress(const JobStatus& work, float scale) {
  const std::string stage = work.stage.empty() ? "waiting" : work.stage;
  const std::string text = work.of > 0 ? fmt::format("{} {}/{}", stage, work.done, work.of) : stage;
  ImGui::TextUnformatted(text.c_str());
  // At a fixed place: a bar that moves with its text is hard to read.
  ImGui::SameLine(std::max(190 * scale, ImGui::CalcTextSize(text.c_str()).x + 24 * scale));
  if (work.of > 0) draw_bar(static_cast<float>(work.done) / static_cast<float>(work.of), scale);
  colored_text(Role::text_dim, "Esc cancels");
  ImGui::SameLine();
  return ImGui::GetCursorPosX() + 12 * scale;
}

}  // namespace

void status_line(const PanelInput& input, const Rectangle& place) {
  const float s = input.scale;
  const float padding = std::round((place.height - ImGui::GetTextLineHeight()) / 2);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_color(Role::background));
  {
    const PanelScope panel("status", place, {12 * s, padding});
    const float right = place.width - 12 * s;
    const bool error = !input.worker.error.empty();
    const std::string& message = error ? input.worker.error : input.state.messages.text;
    const Severity severity = message.empty() ? Severity::note : input.state.messages.severity;
    const std::uint32_t color = error ? gpo::color_of(Role::bad) : color_of(severity);
    if (const auto work = current_work(input)) {
      const float left = draw_progress(*work, s);
      ImGui::SetCursorPosX(std::max(left, right - ImGui::CalcTextSize(message.c_str()).x));
      clipped_text(message, right - left, color);
    } else {
      clipped_text(message.empty() ? "F1 lists the keys, Ctrl+P finds every command" : message,
                   right - 12 * s,
                   color);
    }
  }
  ImGui::PopStyleColor();
}

}  // namespace gpo
