// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench_window.h"

#include "engine/base/error.h"
#include "engine/experiment/configuration.h"
#include "ui/context/framebuffer.h"
#include "ui/context/offscreen_context.h"
#include "ui/context/theme.h"
#include "ui/workbench/commands.h"
#include "ui/workbench/layout.h"
#include "ui/workbench/session/session_file.h"

#include <GL/glew.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

namespace gpo {
namespace {

/// Dear ImGui knows the size of a table or a popup only after it has drawn it once.
constexpr int kFramesToSettle = 3;

void clear(std::uint32_t rgb) {
  glDisable(GL_SCISSOR_TEST);
  glClearColor(static_cast<float>(red(rgb)),
               static_cast<float>(green(rgb)),
               static_cast<float>(blue(rgb)),
               1);
  glClear(GL_COLOR_BUFFER_BIT);
}

void draw_views(const PanelInput& input,
                const WindowLayout& layout,
                Views& views,
                Commands& commands) {
  if (layout.views.empty()) return;
  if (!input.state.document.recording) return empty_panel(input, layout.views, commands);
  if (input.state.view.panes.compare) return compare_panel(input, layout.views, views, commands);
  if (!layout.image.empty()) image_panel(input, layout.image, views, commands);
  if (layout.side.empty()) return;
  side_tabs(input, layout.side_tabs, commands);
  side_pane(input, layout.side, views, commands);
}

/// Everything has another color now, also what nobody draws anew.
void use_theme(const PanelInput& input, Gui& gui, Views& views) {
  if (gui.theme() == input.state.view.theme) return;
  gui.set_theme(input.state.view.theme);
  views.window = WindowImage();
}

/// Nothing is lit up any more when the mouse leaves the views.
void forget_hover(const PanelInput& input, const Rectangle& views, Commands& commands) {
  const ImVec2 at = ImGui::GetIO().MousePos;
  const bool outside =
      at.x < views.x || at.x >= views.right() || at.y < views.y || at.y >= views.bottom();
  if (outside && input.state.hover != Hover{}) push(commands, HoverOver{});
}

void draw_panels(const PanelInput& input, cv::Size size, Views& views, Commands& commands) {
  const Rectangle window{0, 0, static_cast<float>(size.width), static_cast<float>(size.height)};
  const ViewState& view = input.state.view;
  const WindowLayout layout = window_layout({.width = window.width,
                                             .height = window.height,
                                             .scale = input.scale,
                                             .division = view.division,
                                             .drawer_open = view.panes.drawer != nullptr,
                                             .scan = view.toggles.scan});
  menu_bar(input, commands);
  if (!layout.settings.empty()) settings_panel(input, layout.settings, commands);
  if (!layout.results.empty()) results_panel(input, layout.results);
  draw_views(input, layout, views, commands);
  if (!layout.drawer_tabs.empty()) drawer_tabs(input, layout.drawer_tabs, commands);
  if (!layout.drawer.empty()) drawer(input, layout.drawer, views, commands);
  if (!layout.timeline.empty()) timeline_panel(input, layout.timeline, commands);
  status_line(input, layout.status);
  splitters(input, layout, commands);
  forget_hover(input, layout.views, commands);
  if (input.state.view.show_help) help_overlay(input, window, commands);
  if (input.state.view.palette)
    palette_overlay(input, window, views, commands);
  else
    views.palette = {};
  if (input.state.view.browse)
    browser_overlay(input, window, views, commands);
  else
    views.browser.open = false;
}

/// One view that fills the framebuffer; between `begin_frame` and `end_frame`.
void draw_alone(const Pane& pane, const PanelInput& input, cv::Size size, Views& views) {
  const Rectangle place{0, 0, static_cast<float>(size.width), static_cast<float>(size.height)};
  Commands ignored;
  WorkbenchState state = input.state;
  const PanelInput shown{state, input.worker, input.survey, input.timings, input.scale};
  if (pane.kind == PaneKind::side) {
    state.view.panes.side = &pane;
    side_pane(shown, place, views, ignored);
  } else if (pane.kind == PaneKind::drawer) {
    state.view.panes.drawer = &pane;
    drawer(shown, place, views, ignored);
  } else {
    draw_function(pane)(input, place, views, ignored);
  }
}

const Pane& pane_named(const std::string& name) {
  if (const Pane* pane = find_pane(name)) return *pane;
  throw InputError(fmt::format(
      "screenshot: unknown view '{}', expected one of {}", name, fmt::join(pane_names(), ", ")));
}

/// As large as the view is in a window of that size; the picture as it was recorded.
cv::Size own_size(const Pane& pane, const PanelInput& input, cv::Size window) {
  if (pane.kind == PaneKind::window) return window;
  if (!input.state.document.recording) throw InputError("no recording is open");
  const Camera& camera = input.state.document.recording->camera;
  if (pane.kind == PaneKind::image) return {camera.width, camera.height};
  const bool below = pane.kind == PaneKind::drawer;
  const WindowLayout layout = window_layout({.width = static_cast<float>(window.width),
                                             .height = static_cast<float>(window.height),
                                             .scale = input.scale,
                                             .drawer_open = below});
  const Rectangle& place = below                         ? layout.drawer
                           : pane.kind == PaneKind::side ? layout.side
                                                         : layout.views;
  return {static_cast<int>(place.width), static_cast<int>(place.height)};
}

}  // namespace

Commands draw_workbench(
    const PanelInput& input, cv::Size size, Gui& gui, Views& views, double delta_seconds) {
  Commands commands;
  use_theme(input, gui, views);
  gui.begin_frame(size.width, size.height, 1, delta_seconds);
  draw_panels(input, size, views, commands);
  gui.end_frame(views.window, color_of(Role::border));
  return commands;
}

cv::Mat draw_view(const PaneRequest& request, const PanelInput& input, Gui& gui, Views& views) {
  const Pane& pane = pane_named(request.view);
  const cv::Size size = request.size.value_or(own_size(pane, input, request.window_size));
  const Framebuffer framebuffer(size.width, size.height);
  framebuffer.bind();
  use_theme(input, gui, views);
  for (int i = 0; i < kFramesToSettle; ++i) {
    if (pane.kind == PaneKind::window) {
      draw_workbench(input, size, gui, views);
    } else {
      clear(color_of(Role::background));
      gui.begin_frame(size.width, size.height);
      draw_alone(pane, input, size, views);
      gui.end_frame();
    }
  }
  return read_bound_framebuffer(size.width, size.height);
}

cv::Mat snapshot_pane(const std::string& view,
                      const std::shared_ptr<const Inspection>& inspection,
                      int frame,
                      std::optional<cv::Size> size) {
  constexpr int kWidth = 1280, kHeight = 720;
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
  const cv::Size window = size.value_or(cv::Size(kWidth, kHeight));
  const OffscreenContext context(window.width, window.height);
  Gui gui;
  Views views;
  const JobStatus idle;
  const SurveyStatus no_survey;
  return draw_view(
      {view, size, {kWidth, kHeight}}, {state, idle, no_survey, false, gui.scale()}, gui, views);
}

cv::Mat snapshot_window(const std::shared_ptr<const Inspection>& inspection,
                        int frame,
                        cv::Size size) {
  return snapshot_pane("window", inspection, frame, size);
}

}  // namespace gpo
