// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui_style.h"

#include "ui/look/palette.h"

#include <cmath>

#include <imgui.h>

extern "C" {
extern const char gpo_font_regular[], gpo_font_regular_end[];
extern const char gpo_font_bold[], gpo_font_bold_end[];
}

namespace gpo {
namespace {

void apply_colors(ImVec4* colors, Theme theme) {
  using enum Role;
  const auto color = [theme](Role role, double alpha = 1) -> ImVec4 {
    const std::uint32_t rgb = color_of(role, theme);
    return {static_cast<float>(red(rgb)),
            static_cast<float>(green(rgb)),
            static_cast<float>(blue(rgb)),
            static_cast<float>(alpha)};
  };
  colors[ImGuiCol_Text] = color(text);
  colors[ImGuiCol_TextDisabled] = color(text_dim);
  colors[ImGuiCol_TextSelectedBg] = color(accent, 0.35);
  colors[ImGuiCol_WindowBg] = colors[ImGuiCol_ChildBg] = color(panel);
  colors[ImGuiCol_MenuBarBg] = color(background);
  colors[ImGuiCol_PopupBg] = color(raised, 0.98);
  colors[ImGuiCol_ModalWindowDimBg] = color(background, 0.6);
  colors[ImGuiCol_Border] = colors[ImGuiCol_Separator] = color(border);
  colors[ImGuiCol_BorderShadow] = ImVec4(0, 0, 0, 0);
  colors[ImGuiCol_FrameBg] = color(raised);
  colors[ImGuiCol_FrameBgHovered] = color(hovered);
  colors[ImGuiCol_FrameBgActive] = color(active);
  colors[ImGuiCol_Button] = colors[ImGuiCol_Header] = color(raised);
  colors[ImGuiCol_ButtonHovered] = colors[ImGuiCol_HeaderHovered] = color(hovered);
  colors[ImGuiCol_ButtonActive] = colors[ImGuiCol_HeaderActive] = color(active);
  colors[ImGuiCol_CheckMark] = colors[ImGuiCol_SliderGrab] = color(accent);
  colors[ImGuiCol_SliderGrabActive] = color(text);
  colors[ImGuiCol_TitleBg] = colors[ImGuiCol_TitleBgCollapsed] = color(background);
  colors[ImGuiCol_TitleBgActive] = color(raised);
  colors[ImGuiCol_Tab] = colors[ImGuiCol_TabUnfocused] = color(panel);
  colors[ImGuiCol_TabHovered] = color(hovered);
  colors[ImGuiCol_TabActive] = colors[ImGuiCol_TabUnfocusedActive] = color(active);
  colors[ImGuiCol_SeparatorHovered] = colors[ImGuiCol_ResizeGripHovered] = color(accent, 0.6);
  colors[ImGuiCol_SeparatorActive] = colors[ImGuiCol_ResizeGripActive] = color(accent);
  colors[ImGuiCol_ResizeGrip] = color(border);
  colors[ImGuiCol_ScrollbarBg] = color(background, 0);
  colors[ImGuiCol_ScrollbarGrab] = color(hovered);
  colors[ImGuiCol_ScrollbarGrabHovered] = colors[ImGuiCol_ScrollbarGrabActive] = color(active);
  colors[ImGuiCol_TableHeaderBg] = color(raised);
  colors[ImGuiCol_TableBorderStrong] = colors[ImGuiCol_TableBorderLight] = color(border);
  colors[ImGuiCol_TableRowBg] = ImVec4(0, 0, 0, 0);
  colors[ImGuiCol_TableRowBgAlt] = color(text, 0.03);
  colors[ImGuiCol_NavHighlight] = color(accent);
  colors[ImGuiCol_PlotHistogram] = colors[ImGuiCol_PlotLines] = color(accent);
}

/// Digits as wide as each other, so that numbers that change do not dance; Inter's own are not.
void add_font(std::string_view font, float size_px) {
  static const ImWchar digits[] = {'0', '9', 0};
  static const ImWchar others[] = {0x0020,
                                   0x024F,  // Latin with ° ² ± × ·
                                   0x0370,
                                   0x03FF,  // Greek
                                   0x2010,
                                   0x2044,  // – … and quotes
                                   0x2190,
                                   0x2199,  // arrows
                                   0x2200,
                                   0x2265,  // − √ ≈ ≤ ≥
                                   0x25A0,
                                   0x25FF,  // ○ ● ▶ ◀
                                   0x2713,
                                   0x2717,  // ticks and crosses
                                   0};
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  ImFontConfig config;
  config.FontDataOwnedByAtlas = false;
  config.OversampleH = 2;
  config.GlyphRanges = digits;
  const float digit_width = std::round(0.53F * size_px);
  config.GlyphMinAdvanceX = config.GlyphMaxAdvanceX = digit_width;
  auto* bytes = const_cast<char*>(font.data());  // ImGui reads them only
  const int count = static_cast<int>(font.size());
  atlas.AddFontFromMemoryTTF(bytes, count, size_px, &config);
  ImFontConfig rest;
  rest.FontDataOwnedByAtlas = false;
  rest.OversampleH = 2;
  rest.MergeMode = true;
  rest.GlyphRanges = others;
  atlas.AddFontFromMemoryTTF(bytes, count, size_px, &rest);
}

}  // namespace

std::string_view regular_font() { return {gpo_font_regular, gpo_font_regular_end}; }

std::string_view bold_font() { return {gpo_font_bold, gpo_font_bold_end}; }

void apply_style(float scale, Theme theme) {
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  apply_colors(style.Colors, theme);
  style.WindowPadding = ImVec2(12, 10);
  style.FramePadding = ImVec2(9, 5);
  style.ItemSpacing = ImVec2(8, 7);
  style.ItemInnerSpacing = ImVec2(7, 4);
  style.CellPadding = ImVec2(8, 4);
  style.WindowBorderSize = style.PopupBorderSize = style.ChildBorderSize = 1;
  style.FrameBorderSize = style.TabBorderSize = 0;
  style.WindowRounding = style.ChildRounding = 0;
  style.FrameRounding = style.PopupRounding = style.GrabRounding = style.TabRounding = 4;
  style.ScrollbarRounding = 6;
  style.ScrollbarSize = 12;
  style.GrabMinSize = 11;
  style.WindowTitleAlign = ImVec2(0.0F, 0.5F);
  style.ScaleAllSizes(scale);
}

void load_fonts(float scale) {
  const auto size = [scale](float at_96_dpi) { return std::round(at_96_dpi * scale); };
  add_font(regular_font(), size(16));
  add_font(bold_font(), size(16));
  add_font(regular_font(), size(14));
  add_font(bold_font(), size(20));
}

}  // namespace gpo
