// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspection.h"
#include "engine/inspection/inspector.h"
#include "engine/inspection/studies/normal_study.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/benchmark/measure.h"
#include "tests/benchmark/tables.h"
#include "ui/context/gui.h"
#include "ui/context/offscreen_context.h"
#include "ui/context/theme.h"
#include "ui/context/vtk_window.h"
#include "ui/context/window_image.h"
#include "ui/views/compare/compare_view.h"
#include "ui/views/image/image_view.h"
#include "ui/views/image/image_texture.h"
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

/// The same window of the bundled recording by four methods.
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

/// Draws one frame of the recording; owns what it needs in the graphics memory.
class View {
 public:
  virtual ~View() = default;
  virtual void draw(int frame) = 0;
};

ScreenRect whole() { return {{0, 0}, {kSize.width, kSize.height}}; }

class ImageView : public View {
 public:
  explicit ImageView(const Inspections& inspections) : inspection_(*inspections.front()) {}
  void draw(int frame) override {
    if (frame != frame_) texture_.upload(inspection_.recording->images->bgr(frame));
    frame_ = frame;
    gui_.begin_frame(kSize.width, kSize.height);
    draw_image_view(
        *ImGui::GetBackgroundDrawList(), whole(), inspection_, frame, &texture_, {}, {});
    gui_.end_frame(image_, color_of(Role::border));
  }

 private:
  Gui gui_;
  WindowImage image_;
  ImageTexture texture_;
  int frame_ = -1;
  const Inspection& inspection_;
};

class CompareView : public View {
 public:
  explicit CompareView(const Inspections& inspections) : inspections_(inspections) {}
  void draw(int frame) override {
    if (frame != frame_) texture_.upload(inspections_[0]->recording->images->bgr(frame));
    frame_ = frame;
    gui_.begin_frame(kSize.width, kSize.height);
    draw_compare_view(*ImGui::GetBackgroundDrawList(), whole(), inspections_, frame, &texture_);
    gui_.end_frame(image_, color_of(Role::border));
  }

 private:
  Gui gui_;
  WindowImage image_;
  ImageTexture texture_;
  int frame_ = -1;
  const Inspections& inspections_;
};

class OnlyScene : public View {
 public:
  explicit OnlyScene(const Inspections& inspections)
      : inspection_(*inspections.front()),
        camera_(default_scene_camera(inspection_,
                                     cube_side(inspection_, 0),
                                     kSize.width / static_cast<double>(kSize.height))) {}
  void draw(int frame) override {
    gui_.begin_frame(kSize.width, kSize.height);
    draw_scene_view(
        *ImGui::GetBackgroundDrawList(), whole(), view_, inspection_, frame, camera_, options_);
    gui_.end_frame(image_, color_of(Role::border));
  }

 private:
  Gui gui_;
  WindowImage image_;
  SceneView view_;
  const Inspection& inspection_;

 protected:
  OrbitCamera camera_;
  ViewOptions options_;
};

/// Dragged a little from each frame to the next.
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

/// With what is open in it.
class WholeWindow : public View {
 public:
  explicit WholeWindow(const Inspections& inspections) {
    const auto& inspection = inspections.front();
    state_.document.settings = inspection->settings;
    apply_recording(state_, inspection->recording);
    state_.results.inspection = inspection;
  }
  void draw(int frame) override {
    apply(state_, GoToFrame{frame});
    draw_workbench({state_, idle_, no_survey_}, kSize, gui_, views_);
  }

 protected:
  WorkbenchState state_;

 private:
  Gui gui_;
  Views views_;
  JobStatus idle_;
  SurveyStatus no_survey_;
};

/// The views whose content changes with every frame.
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

/// As the window does beside the user: every method of the paper on 60 frames, in one thread, until
/// it is stopped.
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

/// Until the picture is finished, not until it is ordered.
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
  const auto inspections = std::make_shared<Inspections>();  // made when first asked for
  for (const Row& row : kRows) {
    for (const Frames frames : kFrames) {
      benchmark::RegisterBenchmark(name_of(row, frames).c_str(),
                                   [row, frames, inspections](benchmark::State& state) {
                                     if (inspections->empty()) *inspections = inspect_desk();
                                     row.run(state, *inspections, frames);
                                   })
          ->UseRealTime()
          ->MinTime(0.3)
          ->Repetitions(kRepetitions);
    }
  }
}

void print_view_tables(const Results& results) {
  fmt::print("\nViews off-screen at {}x{} until the picture is finished [ms]:\n\n",
             kSize.width,
             kSize.height);
  print_head({"view",
              "unchanged",
              "step to a decoded frame",
              "step while seven methods compute 60 frames"});
  for (const Row& row : kRows) {
    std::vector<std::string> cells{row.name};
    for (const Frames frames : kFrames)
      cells.push_back(cell(results.least(name_of(row, frames), "ms")));
    print_row(cells);
  }
}

}  // namespace gpo::bench
