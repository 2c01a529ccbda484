// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/widgets.h"

#include "ui/context/gui.h"
#include "ui/context/theme.h"

#include <algorithm>
#include <cmath>

namespace gpo {

PanelScope::PanelScope(const char* name, const Rectangle& place, ImVec2 padding, bool scrolls) {
  ImGui::SetNextWindowPos({place.x, place.y});
  ImGui::SetNextWindowSize({place.width, place.height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, padding);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0F);
  // The least size of a window would push small parts over their neighbors.
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::Begin(name,
               nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                   ImGuiWindowFlags_NoNav | (scrolls ? 0 : ImGuiWindowFlags_NoScrollbar));
  // The panel's alone: tooltips and popups have their own.
  ImGui::PopStyleVar(3);
}

PanelScope::~PanelScope() { ImGui::End(); }

OverlayScope::OverlayScope(const char* name, const Rectangle& window, float width, float scale) {
  width = std::min(width, window.width - 16 * scale);
  ImGui::SetNextWindowFocus();
  ImGui::SetNextWindowPos({std::round((window.width - width) / 2), std::round(60 * scale)});
  ImGui::SetNextWindowSize({width, 0});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_color(Role::raised));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * scale);
  ImGui::Begin(name,
               nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize);
}

OverlayScope::~OverlayScope() {
  ImGui::End();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
}

int moved_choice(int chosen, int first, int rows) {
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_DownArrow))) ++chosen;
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_UpArrow))) --chosen;
  return std::clamp(chosen, first, std::max(0, rows - 1));
}

bool hit_area(const char* name, ImVec2 size, ImGuiButtonFlags buttons) {
  return ImGui::InvisibleButton(name, {std::max(1.0F, size.x), std::max(1.0F, size.y)}, buttons);
}

void draw_empty(const Rectangle& place, const std::string& text) {
  const float wrap = place.width * 0.8F;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(
      {place.x, place.y}, {place.right(), place.bottom()}, imgui_color(Role::scene_bottom));
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
  const ImVec2 at(std::round(place.x + (place.width - size.x) / 2),
                  std::round(place.y + (place.height - size.y) / 2));
  list.AddText(ImGui::GetFont(),
               ImGui::GetFontSize(),
               at,
               imgui_color(Role::text_dim),
               text.c_str(),
               nullptr,
               wrap);
}

void table_header(std::span<const ColumnText> columns) {
  ImGui::TableNextRow();
  for (const ColumnText& column : columns) {
    if (!ImGui::TableNextColumn()) continue;
    colored_text(Role::text_dim, column.title);
    tooltip(column.meaning);
  }
}

void marked_name(Sign sign, std::uint32_t rgb, const std::string& name, float scale) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float half = ImGui::GetTextLineHeight() / 2;
  draw_sign(*ImGui::GetWindowDrawList(), sign, {at.x + half, at.y + half}, rgb);
  ImGui::SetCursorScreenPos({at.x + 18 * scale, at.y});
  ImGui::TextUnformatted(name.c_str());
}

void colored_text(std::uint32_t rgb, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(rgb));
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
}

void colored_text(Role role, const std::string& text) { colored_text(color_of(role), text); }

void heading(const char* text) {
  ImGui::PushFont(font(Font::small));
  colored_text(Role::text_dim, text);
  ImGui::PopFont();
}

void tooltip(const std::string& text) {
  if (!text.empty() && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
    show_tooltip(text);
}

void show_tooltip(const std::string& text) {
  ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 1.0F);  // of a disabled item, too
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 22);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
  ImGui::PopStyleVar();
}

void clipped_text(const std::string& text, float width, std::uint32_t rgb) {
  std::string shown = text;
  const auto too_wide = [&] { return ImGui::CalcTextSize(shown.c_str()).x > width; };
  if (too_wide()) {
    do {
      shown = shown.substr(0, shown.size() - 4) + "...";
    } while (shown.size() > 4 && too_wide());
  }
  colored_text(rgb, shown);
  if (shown != text) tooltip(text);
}

}  // namespace gpo
