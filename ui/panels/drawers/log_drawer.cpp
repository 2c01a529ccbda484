// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"

namespace gpo {
namespace {

std::uint32_t color_of(Severity severity) {
  if (severity == Severity::error) return color_of(Role::bad);
  return severity == Severity::warning ? color_of(Role::warning) : color_of(Role::text);
}

}  // namespace

void log_drawer(const PanelInput& input,
                const Rectangle& place,
                Views& /*views*/,
                Commands& /*commands*/) {
  if (input.state.messages.lines.empty()) return draw_empty(place, "No messages yet");
  const float s = input.scale;
  ImGui::SetCursorPos({12 * s, 6 * s});
  ImGui::BeginChild("lines", {place.width - 12 * s, place.height - 6 * s});
  for (const LogLine& line : input.state.messages.lines) {
    colored_text(color_of(line.severity), line.text);
  }
  if (ImGui::GetScrollY() >= ImGui::GetScrollMaxY()) ImGui::SetScrollHereY(1);
  ImGui::EndChild();
}

}  // namespace gpo
