// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"

#include "ui/context/gui_style.h"
#include "ui/context/imgui_versions.h"
#include "ui/context/window_context.h"
#include "ui/context/window_image.h"

#include <algorithm>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace gpo {

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

void Gui::begin_frame(int width, int height, float framebuffer_scale, double delta_seconds) {
  ImGui_ImplOpenGL3_NewFrame();
  if (has_window_) ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(width) / framebuffer_scale,
                          static_cast<float>(height) / framebuffer_scale);
  io.DisplayFramebufferScale = ImVec2(framebuffer_scale, framebuffer_scale);
  // Dear ImGui asserts that time goes on.
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

}  // namespace gpo
