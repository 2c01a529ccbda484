// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspection.h"
#include "engine/inspection/inspector.h"
#include "engine/inspection/studies/studies.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/benchmark/benchmarks.h"
#include "ui/context/gui.h"
#include "ui/context/opengl.h"
#include "ui/context/vtk_window.h"
#include "ui/views/compare/compare_view.h"
#include "ui/views/image/image_view.h"
#include "ui/views/scene/scene_view.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/layout.h"
#include "ui/workbench/session/session_file.h"
#include "ui/workbench_window.h"

#include <thread>

#include <GL/glew.h>
#include <fmt/format.h>
#include <imgui.h>

namespace gpo::bench {
namespace {

const cv::Size kSize(1280, 720);

/// Results of four methods for one window of the bundled recording.
using Inspections = std::vector<std::shared_ptr<const Inspection>>;

Inspections inspect_desk() {
  Inspector inspector(open_recording(GPO_SOURCE_DIR "/sequences/desk"));
  Inspections inspections;
  for (const char* method : {"gpo", "pnp", "dbscan", "ba"})
    inspections.push_back(inspector.inspect({.options = {.method = method}}));
  return inspections;
}

/// Draws frames of the recording, as parts of a window or as the whole window.
struct Canvas {
  explicit Canvas(const Inspections& results) : inspections(results) {
    const auto& inspection = results.front();
    state.document.settings = inspection->settings;
    apply_recording(state, inspection->recording);
    state.results.inspection = inspection;
    camera = default_scene_camera(
        *inspection, cube_side(*inspection, 0), kSize.width / static_cast<double>(kSize.height));
  }
  /// Draws a frame of the window with what `draw` adds to its area.
  template <class Draw>
  void show(const Draw& draw) {
    gui.begin_frame(kSize.width, kSize.height);
    draw(Area{*ImGui::GetBackgroundDrawList(), {{0, 0}, {kSize.width, kSize.height}}});
    gui.end_frame(views.window, color_of(Role::border));
  }
  ImageTexture* image_of(int frame) {
    if (frame != views.frame) views.image.upload(inspections[0]->recording->images->bgr(frame));
    views.frame = frame;
    return &views.image;
  }

  const Inspections& inspections;
  Gui gui;
  Views views;
  WorkbenchState state;
  OrbitCamera camera;
  ViewOptions options;
};

void draw_image(Canvas& canvas, int frame) {
  ImageTexture* image = canvas.image_of(frame);
  canvas.show([&](const Area& area) {
    draw_image_view(area, {*canvas.inspections[0], frame, canvas.options}, image);
  });
}

void draw_compare(Canvas& canvas, int frame) {
  ImageTexture* image = canvas.image_of(frame);
  std::vector<Compared> columns;
  for (const auto& one : canvas.inspections)
    columns.push_back({configuration_of(one->settings), one->settings, one});
  const Recording& recording = *canvas.inspections[0]->recording;
  canvas.show([&](const Area& area) {
    draw_compare_view(area, columns, {recording, frame, image, canvas.options});
  });
}

void draw_scene(Canvas& canvas, int frame) {
  canvas.show([&](const Area& area) {
    const FrameView view{*canvas.inspections[0], frame, canvas.options};
    draw_scene_view(area, view, canvas.views.scene, canvas.camera);
  });
}

/// Drags the scene a little between frames.
void draw_orbited(Canvas& canvas, int frame) {
  canvas.options.detail = SceneDetail::dragged;
  canvas.camera.yaw_deg = 35 + 2 * frame;
  draw_scene(canvas, 0);
}

void draw_window(Canvas& canvas, int frame) {
  apply(canvas.state, GoToFrame{frame});
  draw_workbench({.state = canvas.state}, kSize, canvas.gui, canvas.views);
}

/// Opens the views whose content changes with every frame.
void draw_busy_window(Canvas& canvas, int frame) {
  if (!canvas.state.results.study) {
    canvas.state.results.study = study_normals(*canvas.inspections[0]);
    canvas.state.view.panes = {.side = find_pane("normals", side_panes()),
                               .drawer = find_pane("residuals", drawers())};
  }
  draw_window(canvas, frame);
}

enum class Frames { unchanged, stepping, stepping_while_computing };
using enum Frames;
constexpr Frames kFrames[] = {unchanged, stepping, stepping_while_computing};

/// Computes the methods of the paper on 60 frames over and over, like the worker of the window.
std::jthread compute(Frames frames) {
  if (frames != stepping_while_computing) return {};
  return std::jthread([](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      Inspector inspector(open_recording(GPO_SOURCE_DIR "/sequences/desk"));
      for (const char* method : {"gpo", "pnp", "dbscan", "ba", "pnp_ba", "pba", "fpba"})
        inspector.inspect({.frames = 60, .options = {.method = method}}, stop);
    }
  });
}

struct Row {
  const char* name;
  void (*draw)(Canvas& canvas, int frame);
};

constexpr Row kRows[] = {{"image", draw_image},
                         {"scene", draw_scene},
                         {"scene, orbited", draw_orbited},
                         {"compare, 4 methods", draw_compare},
                         {"window", draw_window},
                         {"window with normals and residuals", draw_busy_window}};

/// Measures until the image is finished, not only requested.
void measure_row(benchmark::State& state,
                 const Row& row,
                 const Inspections& inspections,
                 Frames frames) {
  const VtkMessages vtk;
  OffscreenContext context(kSize.width, kSize.height);
  Canvas canvas(inspections);
  const int count = inspections.front()->settings.frames;
  const std::jthread computing = compute(frames);
  int frame = 0;
  const auto draw = [&] {
    context.bind();
    row.draw(canvas, frame);
    glFinish();
    if (frames != unchanged) frame = (frame + 1) % count;
  };
  for (int k = 0; k < 3; ++k) draw();  // sizes settle, shaders are compiled
  measure(state, wall_ms, draw);
  if (!vtk.text().empty()) state.SkipWithError(vtk.text().c_str());
}

std::string name_of(const Row& row, Frames frames) {
  const char* const names[] = {"unchanged", "stepping", "stepping while computing"};
  return fmt::format("view/{}/{}", row.name, names[static_cast<int>(frames)]);
}

}  // namespace

void register_view_benchmarks() {
  const auto inspections = std::make_shared<Inspections>();  // computed when first needed
  for (const Row& row : kRows)
    for (const Frames frames : kFrames) {
      const auto run = [row, frames, inspections](benchmark::State& state) {
        if (inspections->empty()) *inspections = inspect_desk();
        measure_row(state, row, *inspections, frames);
      };
      add(name_of(row, frames), run, 0.3)->UseRealTime();
    }
}

void print_view_tables(const Results& results) {
  fmt::print("\nViews off-screen at {}x{} until the image is finished [ms]:\n\n",
             kSize.width,
             kSize.height);
  print_head(
      "view | unchanged | step to a decoded frame | step while seven methods compute 60 frames");
  for (const Row& row : kRows) {
    std::vector<std::string> cells{row.name};
    for (const Frames frames : kFrames) cells.push_back(cell(results.ms(name_of(row, frames))));
    print_row(cells);
  }
}

}  // namespace gpo::bench
