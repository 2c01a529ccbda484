// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Says what a live source and its window lack, in place of the failure banner.
#include "ui/panels/panels.h"
#include "ui/workbench/work/live_session.h"

namespace gpo {
namespace {

Role role_of_live(const LiveView& live) {
  if (!live.capture.message.empty()) return Role::warning;
  return live.answer && live.answer->missing.empty() ? Role::good : Role::accent;
}

}  // namespace

void live_banner(const PanelContext& ui, const Rectangle& place) {
  const float s = ui.scale;
  const LiveView& live = *ui.state.live;
  const std::uint32_t color = color_of(role_of_live(live));
  ImGui::PushStyleColor(ImGuiCol_WindowBg,
                        imgui_color(mixed_rgb(color_of(Role::raised), color, 0.18)));
  {
    const float padding = std::round((place.height - ImGui::GetTextLineHeight()) / 2);
    const PanelScope scope("banner", place, {12 * s, padding});
    const std::string counts = counts_text(live);
    const float counts_width = ImGui::CalcTextSize(counts.c_str()).x;
    const float button_width = 76 * s;
    const float room = place.width - 24 * s - button_width - 12 * s;
    clipped_text("Live: " + progress_text(live),
                 std::max(60 * s, room - counts_width - 12 * s),
                 color_of(Role::text));
    if (room - counts_width > 160 * s) {
      ImGui::SameLine(12 * s + room - counts_width);
      colored_text(Role::text_dim, counts);
    }
    ImGui::SameLine(place.width - 12 * s - button_width);
    ImGui::PushStyleColor(ImGuiCol_Button, imgui_color(Role::active));
    if (ImGui::SmallButton("Freeze")) push(ui.commands, RunAction{"freeze"});
    ImGui::PopStyleColor();
    tooltip("Space. " + action_named("freeze").tooltip);
  }
  ImGui::PopStyleColor();
}

}  // namespace gpo
