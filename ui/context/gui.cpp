// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"

#include "ui/context/imgui_versions.h"
#include "ui/context/opengl.h"
#include "ui/context/window_image.h"

#include <algorithm>

#include <backends/imgui_impl_opengl3.h>

extern "C" {
extern const char gpo_font_regular[], gpo_font_regular_end[];
extern const char gpo_font_bold[], gpo_font_bold_end[];
}

namespace gpo {
namespace {

void apply_colors(ImVec4* colors, Theme theme) {
  using enum Role;
  struct Row {
    ImGuiCol item;
    Role role;
    float alpha = 1;
  };
  // clang-format off
  static constexpr Row kRows[] = {
      {ImGuiCol_Text, text}, {ImGuiCol_TextDisabled, text_dim}, {ImGuiCol_TextSelectedBg, accent, 0.35F},
      {ImGuiCol_WindowBg, panel}, {ImGuiCol_ChildBg, panel}, {ImGuiCol_MenuBarBg, background},
      {ImGuiCol_PopupBg, raised, 0.98F}, {ImGuiCol_ModalWindowDimBg, background, 0.6F},
      {ImGuiCol_Border, border}, {ImGuiCol_BorderShadow, border, 0}, {ImGuiCol_FrameBg, raised},
      {ImGuiCol_FrameBgHovered, hovered}, {ImGuiCol_FrameBgActive, active},
      {ImGuiCol_Button, raised}, {ImGuiCol_ButtonHovered, hovered}, {ImGuiCol_ButtonActive, active},
      {ImGuiCol_Header, raised}, {ImGuiCol_HeaderHovered, hovered}, {ImGuiCol_HeaderActive, active},
      {ImGuiCol_CheckMark, accent}, {ImGuiCol_SliderGrab, accent}, {ImGuiCol_SliderGrabActive, text},
      {ImGuiCol_TitleBg, background}, {ImGuiCol_TitleBgCollapsed, background}, {ImGuiCol_TitleBgActive, raised},
      {ImGuiCol_Tab, panel}, {ImGuiCol_TabUnfocused, panel}, {ImGuiCol_TabHovered, hovered},
      {ImGuiCol_TabActive, active}, {ImGuiCol_TabUnfocusedActive, active}, {ImGuiCol_Separator, border},
      {ImGuiCol_SeparatorHovered, accent, 0.6F}, {ImGuiCol_SeparatorActive, accent},
      {ImGuiCol_ResizeGrip, border}, {ImGuiCol_ResizeGripHovered, accent, 0.6F}, {ImGuiCol_ResizeGripActive, accent},
      {ImGuiCol_ScrollbarBg, background, 0}, {ImGuiCol_ScrollbarGrab, hovered},
      {ImGuiCol_ScrollbarGrabHovered, active}, {ImGuiCol_ScrollbarGrabActive, active},
      {ImGuiCol_TableHeaderBg, raised}, {ImGuiCol_TableBorderStrong, border}, {ImGuiCol_TableBorderLight, border},
      {ImGuiCol_TableRowBg, panel, 0}, {ImGuiCol_TableRowBgAlt, text, 0.03F}, {ImGuiCol_NavHighlight, accent},
      {ImGuiCol_PlotHistogram, accent}, {ImGuiCol_PlotLines, accent}};
  // clang-format on
  for (const auto& [item, role, alpha] : kRows) {
    colors[item] = ImGui::ColorConvertU32ToFloat4(imgui_color(color_of(role, theme)));
    colors[item].w = alpha;
  }
}

/// Adds a font with digits of equal width, so that changing numbers do not move; Inter's differ.
void add_font(std::string_view font, float size_px) {
  static const ImWchar digits[] = {'0', '9', 0};
  // Latin with ° ² ± × ·, Greek, – … and quotes, arrows, − √ ≈ ≤ ≥, ○ ● ▶ ◀, ticks and crosses.
  // clang-format off
  static const ImWchar others[] = {0x0020, 0x024F, 0x0370, 0x03FF, 0x2010, 0x2044, 0x2190, 0x2199,
                                   0x2200, 0x2265, 0x25A0, 0x25FF, 0x2713, 0x2717, 0};
  // clang-format on
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  auto* bytes = const_cast<char*>(font.data());  // Dear ImGui only reads them
  for (const ImWchar* ranges : {digits, others}) {
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    config.OversampleH = 2;
    config.GlyphRanges = ranges;
    config.MergeMode = ranges == others;
    if (ranges == digits)
      config.GlyphMinAdvanceX = config.GlyphMaxAdvanceX = std::round(0.53F * size_px);
    atlas.AddFontFromMemoryTTF(bytes, static_cast<int>(font.size()), size_px, &config);
  }
}

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

/// In the order of `Font`.
void load_fonts(float scale) {
  const auto size = [scale](float at_96_dpi) { return std::round(at_96_dpi * scale); };
  add_font(regular_font(), size(16));
  add_font(bold_font(), size(16));
  add_font(regular_font(), size(14));
  add_font(bold_font(), size(20));
}

}  // namespace

std::string_view regular_font() { return {gpo_font_regular, gpo_font_regular_end}; }

std::string_view bold_font() { return {gpo_font_bold, gpo_font_bold_end}; }

ImFont* font(Font font) { return ImGui::GetIO().Fonts->Fonts[static_cast<int>(font)]; }

void Gui::create() {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  io.UserData = this;
  apply_style(scale_, theme_);
  load_fonts(scale_);
}

Gui::Gui(float content_scale) : screen_scale_(content_scale), has_window_(false) {
  create();
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

Gui::Gui(WindowContext& window) : screen_scale_(window.content_scale()), has_window_(true) {
  create();
  take_events_as_they_come();
  ImGui_ImplGlfw_InitForOpenGL(window.glfw(), false);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

Gui::~Gui() {
  ImGui_ImplOpenGL3_Shutdown();
  if (has_window_) ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Gui::set_theme(Theme theme) {
  theme_ = theme;
  apply_style(scale_, theme_);
}

void Gui::set_zoom(double zoom) {
  const float scale = screen_scale_ * static_cast<float>(zoom);
  if (scale == scale_) return;
  scale_ = scale;
  apply_style(scale_, theme_);
  ImGui::GetIO().Fonts->Clear();
  load_fonts(scale_);
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

void Gui::begin_frame(int width, int height, double delta_seconds) {
  ImGui_ImplOpenGL3_NewFrame();
  if (has_window_) ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
  io.DisplayFramebufferScale = ImVec2(1, 1);
  // Dear ImGui asserts that time passes.
  io.DeltaTime = std::max(static_cast<float>(delta_seconds), 1e-5F);
  ImGui::NewFrame();
}

void Gui::end_frame() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Gui::end_frame(WindowImage& image, std::uint32_t background_rgb) {
  ImGui::Render();
  image.show(*ImGui::GetDrawData(), background_rgb);
}

Theme current_theme() {
  if (ImGui::GetCurrentContext() == nullptr) return Theme::dark;
  const auto* gui = static_cast<const Gui*>(ImGui::GetIO().UserData);
  return gui != nullptr ? gui->theme() : Theme::dark;
}

std::uint32_t color_of(Role role) { return color_of(role, current_theme()); }

std::uint32_t imgui_color(Role role, double alpha) { return imgui_color(color_of(role), alpha); }

}  // namespace gpo
