// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench_window.h"

#include "ui/context/framebuffer.h"
#include "ui/context/offscreen_context.h"
#include "ui/panels/view_options.h"
#include "ui/views/palette.h"
#include "ui/workbench/layout.h"

#include <GL/glew.h>
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

void draw_panels(const PanelInput& input, cv::Size size, Views& views, Commands& commands) {
  const WindowLayout layout =
      window_layout(static_cast<float>(size.width), static_cast<float>(size.height), input.scale);
  menu_bar(input, commands);
  settings_panel(input, layout.settings, commands);
  results_panel(input, layout.results);
  timeline_panel(input, layout.timeline, commands);
  status_line(input, layout.status);
  if (input.state.recording) {
    image_panel(input, layout.picture, views, commands);
    scene_panel(input, layout.scene, views, commands);
  } else {
    const Rectangle& picture = layout.picture;
    const Rectangle& scene = layout.scene;
    empty_panel(input,
                {picture.x, picture.y, scene.right() - picture.x, scene.bottom() - picture.y},
                commands);
  }
  if (input.state.show_help) {
    help_overlay(
        input, {0, 0, static_cast<float>(size.width), static_cast<float>(size.height)}, commands);
  }
}

}  // namespace

Commands draw_workbench(
    const PanelInput& input, cv::Size size, Gui& gui, Views& views, double delta_seconds) {
  Commands commands;
  gui.begin_frame(size.width, size.height, 1, delta_seconds);
  draw_panels(input, size, views, commands);
  gui.end_frame(views.window, palette::kBorder);
  return commands;
}

cv::Mat draw_picture(const PanelInput& input, Gui& gui, Views& views) {
  const Camera& camera = input.state.recording->camera;
  const Inspection waiting = nothing_inspected(input.state.recording);
  const Framebuffer framebuffer(camera.width, camera.height);
  framebuffer.bind();
  clear(palette::kBackground);
  gui.begin_frame(camera.width, camera.height);
  draw_image_view(*ImGui::GetBackgroundDrawList(),
                  {{0, 0}, {camera.width, camera.height}},
                  input.inspection ? *input.inspection : waiting,
                  input.state.frame,
                  input.state.recording->pictures ? &views.picture : nullptr,
                  {},
                  image_options(input.state, input.inspection));
  gui.end_frame();
  return read_bound_framebuffer(camera.width, camera.height);
}

cv::Mat snapshot_window(const std::shared_ptr<const Inspection>& inspection,
                        int frame,
                        cv::Size size) {
  WorkbenchState state;
  state.settings = inspection->settings;
  adopt(state, inspection->recording);
  state.message.clear();
  apply(state, GoToFrame{frame});
  OffscreenContext context(size.width, size.height);
  Gui gui;
  Views views;
  const WorkerStatus idle;
  context.bind();
  for (int i = 0; i < kFramesToSettle; ++i) {
    draw_workbench({state, inspection.get(), idle, false, gui.scale()}, size, gui, views);
  }
  return context.read_bgr();
}

}  // namespace gpo
