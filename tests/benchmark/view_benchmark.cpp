// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspection.h"
#include "engine/inspection/inspector.h"
#include "engine/inspection/studies/normal_study.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/benchmark/tables.h"
#include "ui/context/gui.h"
#include "ui/context/offscreen_context.h"
#include "ui/context/theme.h"
#include "ui/context/vtk_window.h"
#include "ui/context/window_image.h"
#include "ui/views/compare/compare_view.h"
#include "ui/views/image/image_texture.h"
#include "ui/views/image/image_view.h"
#include "ui/views/scene/scene_geometry.h"
#include "ui/workbench/commands.h"
#include "ui/workbench/panes.h"
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
  for (const char* method : {"gpo", "pnp", "dbscan", "ba"}) {
    Settings settings;
    settings.options.method = method;
    inspections.push_back(inspector.inspect(settings));
  }
  return inspections;
}

/// Draws one frame of the recording.
class View {
 public:
  explicit View(const Inspections& inspections) : inspections_(inspections) {}
  virtual ~View() = default;
  virtual void draw(int frame) = 0;

 protected:
  /// Draws a frame of the window with what `draw` adds to a list.
  template <class Draw>
  void show(const Draw& draw) {
    gui_.begin_frame(kSize.width, kSize.height);
    draw(*ImGui::GetBackgroundDrawList(), ScreenRect{{0, 0}, {kSize.width, kSize.height}});
    gui_.end_frame(image_, color_of(Role::border));
  }
  ImageTexture* image_of(int frame) {
    if (frame != frame_) texture_.upload(inspections_[0]->recording->images->bgr(frame));
    frame_ = frame;
    return &texture_;
  }

  const Inspections& inspections_;
  Gui gui_;

 private:
  WindowImage image_;
  ImageTexture texture_;
  int frame_ = -1;
};

class ImageView : public View {
 public:
  using View::View;
  void draw(int frame) override {
    ImageTexture* image = image_of(frame);
    show([&](ImDrawList& list, const ScreenRect& rect) {
      draw_image_view(list, rect, *inspections_[0], frame, image, {}, {});
    });
  }
};

class CompareView : public View {
 public:
  using View::View;
  void draw(int frame) override {
    ImageTexture* image = image_of(frame);
    show([&](ImDrawList& list, const ScreenRect& rect) {
      draw_compare_view(list, rect, inspections_, frame, image);
    });
  }
};

class OnlyScene : public View {
 public:
  explicit OnlyScene(const Inspections& inspections)
      : View(inspections),
        camera_(default_scene_camera(*inspections[0],
                                     cube_side(*inspections[0], 0),
                                     kSize.width / static_cast<double>(kSize.height))) {}
  void draw(int frame) override {
    show([&](ImDrawList& list, const ScreenRect& rect) {
      draw_scene_view(list, rect, view_, *inspections_[0], frame, camera_, options_);
    });
  }

 protected:
  OrbitCamera camera_;
  ViewOptions options_;

 private:
  SceneView view_;
};

/// The scene, dragged a little between frames.
class OrbitingScene : public OnlyScene {
 public:
  explicit OrbitingScene(const Inspections& inspections) : OnlyScene(inspections) {
    options_.moving = true;
  }
  void draw(int frame) override {
    camera_.yaw_deg = 35 + 2 * frame;
    OnlyScene::draw(0);
  }
};

class WholeWindow : public View {
 public:
  explicit WholeWindow(const Inspections& inspections) : View(inspections) {
    const auto& inspection = inspections.front();
    state_.document.settings = inspection->settings;
    apply_recording(state_, inspection->recording);
    state_.results.inspection = inspection;
  }
  void draw(int frame) override {
    apply(state_, GoToFrame{frame});
    draw_workbench({.state = state_}, kSize, gui_, views_);
  }

 protected:
  WorkbenchState state_;

 private:
  Views views_;
};

/// The window with the views whose content changes with every frame.
class BusyWindow : public WholeWindow {
 public:
  explicit BusyWindow(const Inspections& inspections) : WholeWindow(inspections) {
    state_.results.study = study_normals(*inspections.front(), {});
    state_.view.panes = {find_side_pane("normals"), find_drawer("residuals"), false};
  }
};

enum class Frames { unchanged, stepping, stepping_while_computing };
constexpr Frames kFrames[] = {
    Frames::unchanged, Frames::stepping, Frames::stepping_while_computing};

/// Computes the methods of the paper on 60 frames over and over, like the worker of the window.
std::jthread compute(Frames frames) {
  if (frames != Frames::stepping_while_computing) return {};
  return std::jthread([](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      Inspector inspector(open_recording(GPO_SOURCE_DIR "/sequences/desk"));
      for (const char* method : {"gpo", "pnp", "dbscan", "ba", "pnp_ba", "pba", "fpba"})
        inspector.inspect({.frames = 60, .options = {.method = method}}, stop);
    }
  });
}

/// Measures until the image is finished, not only requested.
template <class V>
void run(benchmark::State& state, const Inspections& inspections, Frames frames) {
  const VtkMessages vtk([&state](const std::string& text) { state.SkipWithError(text.c_str()); });
  OffscreenContext context(kSize.width, kSize.height);
  V view(inspections);
  const int count = inspections.front()->settings.frames;
  const std::jthread computing = compute(frames);
  int frame = 0;
  const auto draw = [&] {
    context.bind();
    view.draw(frame);
    glFinish();
    if (frames != Frames::unchanged) frame = (frame + 1) % count;
  };
  for (int k = 0; k < 3; ++k) draw();  // sizes settle, shaders are compiled
  measure(state, wall_ms, draw);
}

struct Row {
  const char* name;
  void (*run)(benchmark::State& state, const Inspections& inspections, Frames frames);
};

constexpr Row kRows[] = {{"image", run<ImageView>},
                         {"scene", run<OnlyScene>},
                         {"scene, orbited", run<OrbitingScene>},
                         {"compare, 4 methods", run<CompareView>},
                         {"window", run<WholeWindow>},
                         {"window with normals and residuals", run<BusyWindow>}};

std::string name_of(const Row& row, Frames frames) {
  const char* const names[] = {"unchanged", "stepping", "stepping while computing"};
  return fmt::format("view/{}/{}", row.name, names[static_cast<int>(frames)]);
}

}  // namespace

void register_view_benchmarks() {
  const auto inspections = std::make_shared<Inspections>();  // computed when first needed
  for (const Row& row : kRows) {
    for (const Frames frames : kFrames) {
      const auto run = [row, frames, inspections](benchmark::State& state) {
        if (inspections->empty()) *inspections = inspect_desk();
        row.run(state, *inspections, frames);
      };
      add(name_of(row, frames), run, 0.3)->UseRealTime();
    }
  }
}

void print_view_tables(const Results& results) {
  fmt::print("\nViews off-screen at {}x{} until the image is finished [ms]:\n\n",
             kSize.width,
             kSize.height);
  print_head({"view",
              "unchanged",
              "step to a decoded frame",
              "step while seven methods compute 60 frames"});
  for (const Row& row : kRows) {
    std::vector<std::string> cells{row.name};
    for (const Frames frames : kFrames) cells.push_back(cell(results.ms(name_of(row, frames))));
    print_row(cells);
  }
}

}  // namespace gpo::bench
