// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/widgets.h"

#include <algorithm>
#include <cmath>

#include <GL/glew.h>

namespace gpo {

using Eigen::Vector2d;

PanelScope::PanelScope(const char* name, const Rectangle& place, ImVec2 padding, PanelKind kind) {
  ImGui::SetNextWindowPos({place.x, place.y});
  ImGui::SetNextWindowSize({place.width, place.height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, padding);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0F);
  // The default minimum size would make small parts overlap.
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  const bool over = kind == PanelKind::over;
  ImGui::Begin(name,
               nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                   (over ? ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoFocusOnAppearing
                         : ImGuiWindowFlags_NoBringToFrontOnFocus) |
                   (kind == PanelKind::scrolling ? 0 : ImGuiWindowFlags_NoScrollbar));
  ImGui::PopStyleVar(3);  // tooltips and popups inside have their own
}

PanelScope::~PanelScope() { ImGui::End(); }

bool hit_area(const char* name, ImVec2 size, ImGuiButtonFlags buttons) {
  return ImGui::InvisibleButton(name, {std::max(1.0F, size.x), std::max(1.0F, size.y)}, buttons);
}

bool hit_area_at(const char* name, const Rectangle& place) {
  ImGui::SetCursorScreenPos({place.x, place.y});
  return hit_area(name, {place.width, place.height});
}

Vector2d mouse_px() { return {ImGui::GetIO().MousePos.x, ImGui::GetIO().MousePos.y}; }

bool is_click(float scale, int button) {
  const ImVec2& pressed = ImGui::GetIO().MouseClickedPos[button];
  return (mouse_px() - Vector2d(pressed.x, pressed.y)).norm() < 4 * scale;
}

double wheel_zoom() {
  return ImGui::IsItemHovered() ? std::pow(1.25, ImGui::GetIO().MouseWheel) : 1;
}

Vector2d drag_px() {
  if (!ImGui::IsItemActive()) return Vector2d::Zero();
  return {ImGui::GetIO().MouseDelta.x, ImGui::GetIO().MouseDelta.y};
}

bool is_item_double_clicked() {
  return ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
}

void draw_empty(const Rectangle& place, const std::string& text) {
  const float wrap = place.width * 0.8F;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(
      {place.x, place.y}, {place.right(), place.bottom()}, imgui_color(Role::scene_bottom));
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
  const ImVec2 at(std::round(place.x + (place.width - size.x) / 2),
                  std::round(place.y + (place.height - size.y) / 2));
  const ImU32 color = imgui_color(Role::text_dim);
  list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), at, color, text.c_str(), nullptr, wrap);
}

void table_header(std::span<const ColumnText> columns) {
  ImGui::TableNextRow();
  for (const ColumnText& column : columns) {
    if (!ImGui::TableNextColumn()) continue;
    colored_text(Role::text_dim, column.title);
    tooltip(column.meaning);
  }
}

void frozen_header(std::span<const ColumnText> columns) {
  ImGui::TableSetupScrollFreeze(0, 1);
  for (const ColumnText& column : columns) ImGui::TableSetupColumn(column.title);
  table_header(columns);
}

void marked_name(Sign sign, std::uint32_t rgb, const std::string& name, float scale) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  sign_at_cursor(sign, rgb);
  ImGui::SetCursorScreenPos({at.x + 18 * scale, at.y});
  ImGui::TextUnformatted(name.c_str());
}

void sign_at_cursor(Sign sign, std::uint32_t rgb) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float half = ImGui::GetTextLineHeight() / 2;
  draw_sign(*ImGui::GetWindowDrawList(), sign, {at.x + half, at.y + half}, rgb);
}

void colored_text(std::uint32_t rgb, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(rgb));
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
}

void colored_text(Role role, const std::string& text) { colored_text(color_of(role), text); }

Role role_of(Severity severity, Role note) {
  if (severity == Severity::error) return Role::bad;
  return severity == Severity::warning ? Role::warning : note;
}

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
  ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 1.0F);  // opaque for a disabled item, too
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

void clear_framebuffer(std::uint32_t rgb) {
  glDisable(GL_SCISSOR_TEST);
  glClearColor(static_cast<float>(red(rgb)),
               static_cast<float>(green(rgb)),
               static_cast<float>(blue(rgb)),
               1);
  glClear(GL_COLOR_BUFFER_BIT);
}

}  // namespace gpo
