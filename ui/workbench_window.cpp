// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench_window.h"

#include "engine/base/error.h"
#include "ui/context/offscreen_context.h"
#include "ui/workbench/session/session_file.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

/// Dear ImGui knows the sizes of tables and popups only after it has drawn them once.
constexpr int kFramesToSettle = 3;
const cv::Size kDefaultSize(1280, 720);

Rectangle rectangle_of(cv::Size size) {
  return {0, 0, static_cast<float>(size.width), static_cast<float>(size.height)};
}

void draw_views(const PanelContext& ui, const WindowLayout& layout) {
  if (layout.views.empty()) return;
  if (!ui.state.document.recording) return empty_panel(ui, layout.views);
  if (ui.state.view.panes.compare) return compare_panel(ui, layout.views);
  if (!layout.image.empty()) image_panel(ui, layout.image);
  if (layout.side.empty()) return;
  side_tabs(ui, layout.side_tabs);
  side_pane(ui, layout.side);
}

void use_theme(Theme theme, Gui& gui, Views& views) {
  if (gui.theme() == theme) return;
  gui.set_theme(theme);
  views.window = WindowImage();
}

/// Clears the hover when the mouse leaves the views.
void forget_hover(const PanelContext& ui, const Rectangle& views) {
  const ImVec2 at = ImGui::GetIO().MousePos;
  const bool outside =
      at.x < views.x || at.x >= views.right() || at.y < views.y || at.y >= views.bottom();
  if (outside && ui.state.hover != Hover{}) push(ui.commands, HoverOver{});
}

void draw_overlays(const PanelContext& ui, const Rectangle& window) {
  const ViewState& view = ui.state.view;
  if (view.show_help) help_overlay(ui, window);
  if (view.palette) palette_overlay(ui, window);
  if (view.browse) browser_overlay(ui, window);
  ui.views.glossary &= view.show_help;
  if (!view.palette) ui.views.palette = {};
  if (!view.browse) ui.views.browser.open = false;
}

void draw_panels(const PanelContext& ui, cv::Size size) {
  const Rectangle window = rectangle_of(size);
  const ViewState& view = ui.state.view;
  const WindowLayout layout = window_layout({.width = window.width,
                                             .height = window.height,
                                             .scale = ui.scale,
                                             .division = view.division,
                                             .drawer_open = view.panes.drawer != nullptr,
                                             .scan = view.toggles.scan});
  menu_bar(ui);
  if (!layout.settings.empty()) settings_panel(ui, layout.settings);
  if (!layout.results.empty()) results_panel(ui, layout.results);
  draw_views(ui, layout);
  if (!layout.drawer_tabs.empty()) drawer_tabs(ui, layout.drawer_tabs);
  if (!layout.drawer.empty()) drawer(ui, layout.drawer);
  if (!layout.timeline.empty()) timeline_panel(ui, layout.timeline);
  status_line(ui, layout.status);
  splitters(ui, layout);
  forget_hover(ui, layout.views);
  draw_overlays(ui, window);
}

/// Draws one view that fills the framebuffer, between `begin_frame` and `end_frame`.
void draw_alone(const Pane& pane, const PanelContext& ui, cv::Size size) {
  const Rectangle place = rectangle_of(size);
  WorkbenchState state = ui.state;
  if (pane.kind == PaneKind::side) state.view.panes.side = &pane;
  if (pane.kind == PaneKind::drawer) state.view.panes.drawer = &pane;
  const PanelContext shown{ui.with(state), ui.views, ui.commands};
  if (pane.kind == PaneKind::side)
    side_pane(shown, place);
  else if (pane.kind == PaneKind::drawer)
    drawer(shown, place);
  else
    draw_function(pane)(shown, place);
}

const Pane& pane_named(const std::string& name) {
  if (const Pane* pane = find_pane(name)) return *pane;
  throw InputError(fmt::format(
      "screenshot: unknown view '{}', expected one of {}", name, fmt::join(pane_names(), ", ")));
}

/// Returns the size of the view in a window of that size; of the image as recorded. Throws
/// InputError without a recording.
cv::Size default_size(const Pane& pane, const PanelInput& input, cv::Size window) {
  if (pane.kind == PaneKind::window) return window;
  if (!input.state.document.recording) throw InputError("no recording is open");
  const Camera& camera = input.state.document.recording->camera;
  if (pane.kind == PaneKind::image) return {camera.width, camera.height};
  const bool below = pane.kind == PaneKind::drawer;
  const Rectangle whole = rectangle_of(window);
  const WindowLayout layout = window_layout(
      {.width = whole.width, .height = whole.height, .scale = input.scale, .drawer_open = below});
  const Rectangle& place = below                         ? layout.drawer
                           : pane.kind == PaneKind::side ? layout.side
                                                         : layout.views;
  return {static_cast<int>(place.width), static_cast<int>(place.height)};
}

bool button(const std::string& title, float scale, bool first) {
  if (first) ImGui::PushStyleColor(ImGuiCol_Button, imgui_color(Role::active));
  const float width = ImGui::CalcTextSize(title.c_str()).x + 48 * scale;
  const bool clicked = ImGui::Button(title.c_str(), {std::max(width, 120 * scale), 32 * scale});
  if (first) ImGui::PopStyleColor();
  return clicked;
}

void write(const Question& question, float scale) {
  const auto wrapped = [](Role role, const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(role));
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopStyleColor();
  };
  ImGui::PushFont(font(Font::heading));
  wrapped(Role::text, question.title);
  ImGui::PopFont();
  ImGui::Dummy({1, 6 * scale});
  for (const std::string& line : question.lines) wrapped(Role::accent, line);
  ImGui::Dummy({1, 6 * scale});
  wrapped(Role::text_dim, question.advice);
  ImGui::Dummy({1, 10 * scale});
}

}  // namespace

Commands draw_workbench(
    const PanelInput& input, cv::Size size, Gui& gui, Views& views, double delta_seconds) {
  Commands commands;
  PanelContext ui{input, views, commands};
  ui.scale = gui.scale();
  use_theme(input.state.view.theme, gui, views);
  gui.begin_frame(size.width, size.height, delta_seconds);
  draw_panels(ui, size);
  gui.end_frame(views.window, color_of(Role::border));
  return commands;
}

cv::Mat draw_view(const std::string& view,
                  std::optional<cv::Size> wanted,
                  const PanelInput& input,
                  cv::Size window_size,
                  const Drawing& drawing) {
  Gui& gui = drawing.gui;
  Commands ignored;
  PanelContext ui{input, drawing.views, ignored};
  ui.scale = gui.scale();
  const Pane& pane = pane_named(view);
  const cv::Size size = wanted.value_or(default_size(pane, ui, window_size));
  const Framebuffer framebuffer(size.width, size.height);
  framebuffer.bind();
  use_theme(input.state.view.theme, gui, drawing.views);
  for (int i = 0; i < kFramesToSettle; ++i) {
    if (pane.kind == PaneKind::window) {
      draw_workbench(input, size, gui, drawing.views);
    } else {
      clear_framebuffer(color_of(Role::background));
      gui.begin_frame(size.width, size.height);
      draw_alone(pane, ui, size);
      gui.end_frame();
    }
  }
  return read_bound_framebuffer(size.width, size.height);
}

cv::Mat snapshot_pane(const std::string& view,
                      const std::shared_ptr<const Inspection>& inspection,
                      int frame,
                      std::optional<cv::Size> size) {
  WorkbenchState state;
  state.document.settings = inspection->settings;
  apply_recording(state, inspection->recording);
  state.results.inspection = inspection;
  state.messages.text.clear();
  const Pane& pane = pane_named(view);
  if (pane.kind != PaneKind::window)
    state.document.compared = {configuration_of(state.document.settings)};
  if (pane.needs.study) state.results.study = study_normals(*inspection);
  apply(state, GoToFrame{frame});
  const cv::Size window = size.value_or(kDefaultSize);
  const OffscreenContext context(window.width, window.height);
  Gui gui;
  Views views;
  return draw_view(view, size, {.state = state, .timings = false}, kDefaultSize, {gui, views});
}

std::optional<bool> ask(Gui& gui, cv::Size size, const Question& question) {
  const float s = gui.scale();
  const auto window_width = static_cast<float>(size.width);
  std::optional<bool> answer;
  clear_framebuffer(color_of(Role::background));
  gui.begin_frame(size.width, size.height);
  ImGui::SetNextWindowPos({window_width / 2, static_cast<float>(size.height) / 2}, 0, {0.5F, 0.5F});
  ImGui::SetNextWindowSize({std::min(640 * s, window_width - 32 * s), 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {24 * s, 20 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_color(Role::raised));
  ImGui::Begin("question",
               nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  write(question, s);
  if (button(question.no, s, true)) answer = false;
  ImGui::SameLine(0, 12 * s);
  if (button(question.yes, s, false)) answer = true;
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) answer = false;
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(2);
  gui.end_frame();
  return answer;
}

}  // namespace gpo
