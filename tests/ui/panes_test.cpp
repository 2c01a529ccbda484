// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/panes.h"

#include "tests/ui/gl_test.h"
#include "tests/ui/made_inspection.h"
#include "ui/context/offscreen_context.h"
#include "ui/workbench/commands.h"
#include "ui/workbench/session/session_file.h"
#include "ui/workbench_window.h"

#include <cmath>
#include <filesystem>
#include <memory>

#include <gtest/gtest.h>
#include <imgui.h>
#include <opencv2/imgcodecs.hpp>

namespace gpo {
namespace {

/// The window with a pane or a drawer open, off-screen, with a mouse.
class PanesTest : public DrawingTest {
 protected:
  static constexpr int kWidth = 1280, kHeight = 720;

  Commands draw() {
    context_.bind();
    return draw_workbench(
        {state_, idle_, no_survey_, timings_, gui_.scale()}, {kWidth, kHeight}, gui_, *views_);
  }
  void open(const Inspection& inspection) {
    state_.document.settings = inspection.settings;
    apply_recording(state_, inspection.recording);
    state_.results.inspection = std::make_shared<const Inspection>(inspection);
    draw();
  }
  Commands click(float x, float y) {
    ImGui::GetIO().MousePos = {x, y};
    draw();
    Commands all = draw();
    for (const bool down : {true, false}) {
      ImGui::GetIO().MouseDown[0] = down;
      for (const Command& command : draw()) push(all, command);
    }
    return all;
  }
  WindowLayout layout() const {
    return window_layout(
        {.width = kWidth, .height = kHeight, .drawer_open = state_.view.panes.drawer != nullptr});
  }
  cv::Mat drawer_image() {
    draw();
    draw();
    const Rectangle& place = layout().drawer;
    return context_
        .read_bgr()({static_cast<int>(place.x),
                     static_cast<int>(place.y),
                     static_cast<int>(place.width),
                     static_cast<int>(place.height)})
        .clone();
  }

  OffscreenContext context_{kWidth, kHeight};
  Gui gui_;
  std::unique_ptr<Views> views_ = std::make_unique<Views>();
  WorkbenchState state_;
  JobStatus idle_;
  SurveyStatus no_survey_;
  bool timings_ = true;
};

TEST_F(PanesTest, DrawWhateverIsKnown) {
  for (const bool ok : {true, false}) {
    Inspection inspection = made_inspection({.ok = ok});
    open(inspection);
    for (const Pane& pane : side_panes())
      for (const Pane& drawer : drawers()) {
        state_.view.panes.side = &pane;
        state_.view.panes.drawer = &drawer;
        draw();
        EXPECT_TRUE(draw().empty());
      }
    state_.results.inspection.reset();
    draw();
  }
}

TEST_F(PanesTest, ClickInTheFramesOfTheResidualsGoesThere) {
  open(made_inspection({.estimate_error = 1}));
  state_.view.panes.drawer = find_drawer("residuals");
  apply(state_, GoToFrame{34});
  draw();
  const Rectangle place = layout().drawer;
  const Commands commands = click(place.x + 0.7F * place.width, place.y + 0.5F * place.height);
  ASSERT_FALSE(commands.empty());
  const auto* go = std::get_if<GoToFrame>(&commands.front());
  ASSERT_NE(go, nullptr);
  EXPECT_GT(go->frame, 10);
  EXPECT_LT(go->frame, 30);
}

TEST_F(PanesTest, ComputesResidualsAndChartsOnceAnInspection) {
  open(made_inspection({.estimate_error = 1}));
  state_.view.panes.drawer = find_drawer("residuals");
  draw();
  const std::size_t drawn = views_->charts.at("rms over frames").texture().revision();
  apply(state_, GoToFrame{20});
  draw();
  EXPECT_EQ(views_->charts.at("rms over frames").texture().revision(), drawn)
      << "the cursor is drawn over it";
  EXPECT_EQ(views_->residuals.of, state_.results.inspection);
}

/// Candidates and clusters of a simple kind, and a landscape whose valley is at the estimate.
std::shared_ptr<const NormalStudy> made_study(const Inspection& inspection) {
  NormalStudy study;
  study.window = inspection.window;
  const int frames = inspection.window->frame_count();
  const Eigen::Vector3d normal = inspection.initialization->plane.normal;
  study.landscape.side = 16;
  study.landscape.observations.assign(frames, 100);
  study.landscape.cost_px2.assign(frames, std::vector<float>(256));
  for (int i = 0; i < frames; ++i)
    for (int k = 0; k < 256; ++k) {
      const Eigen::Vector2d disc = disc_of_cell(16, k / 16, k % 16);
      const double away = (disc - disc_from_normal(normal)).norm();
      study.landscape.cost_px2[i][k] =
          disc.norm() < 0.9 ? static_cast<float>((i + 1) * (1 + 400 * away * away)) : NAN;
    }
  study.candidates.resize(frames);
  for (int i = 1; i < frames; ++i)
    study.candidates[i] = {{i, {{}, {0.1, 0, 0}, normal}, 0.5, Rejection::none, "", 0, 100},
                           {i, {{}, {0.1, 0, 0}, {0.6, 0, -0.8}}, 9, Rejection::sight, "behind"}};
  study.clusters = {{normal, 1, frames - 1, 2}};
  return std::make_shared<const NormalStudy>(study);
}

TEST_F(PanesTest, NormalsAreZoomedAroundThePointerAndMoved) {
  const Inspection inspection = made_inspection({.estimate_error = 1});
  open(inspection);
  state_.view.panes.side = find_side_pane("normals");
  state_.results.study = made_study(inspection);
  const Rectangle place = layout().side;
  const float x = place.x + 0.6F * place.width, y = place.y + 0.4F * place.height;
  ImGui::GetIO().MousePos = {x, y};
  draw();
  EXPECT_TRUE(draw().empty()) << "resting on it only tells";
  ImGui::GetIO().MouseWheel = 2;
  const Commands zoomed = draw();
  ASSERT_EQ(zoomed.size(), 1U);
  ASSERT_NE(std::get_if<ZoomNormals>(&zoomed[0]), nullptr);
  apply(state_, zoomed[0]);
  EXPECT_NEAR(state_.view.normals_zoom.factor, 1.5625, 1e-9);
  ImGui::GetIO().MouseDown[0] = true;
  draw();
  ImGui::GetIO().MousePos = {x + 30, y};
  const Commands moved = draw();
  ImGui::GetIO().MouseDown[0] = false;
  ASSERT_EQ(moved.size(), 1U);
  EXPECT_LT(std::get<ZoomNormals>(moved[0]).zoom.center.x(), state_.view.normals_zoom.center.x());
}

TEST_F(PanesTest, TheMapIsOfTheFramesUpToTheShownOneAndKeptOtherwise) {
  const Inspection inspection = made_inspection({.estimate_error = 1});
  open(inspection);
  state_.view.panes.side = find_side_pane("normals");
  state_.results.study = made_study(inspection);
  apply(state_, GoToFrame{34});
  draw();
  const std::size_t drawn = views_->normals.texture().revision();
  EXPECT_GT(drawn, 0U);
  draw();
  EXPECT_EQ(views_->normals.texture().revision(), drawn);
  const float all = views_->normals.rms_at({0, 0});
  apply(state_, GoToFrame{12});
  draw();
  EXPECT_EQ(views_->normals.texture().revision(), drawn + 1);
  EXPECT_LT(views_->normals.rms_at({0, 0}), all);
  EXPECT_TRUE(std::isnan(views_->normals.rms_at({0.96, 0.05})));
  EXPECT_FALSE(views_->normals.contours().empty());
  state_.view.panes.side = find_side_pane("candidates");
  for (const int frame : {0, 5, 20}) {
    apply(state_, GoToFrame{frame});
    EXPECT_TRUE(draw().empty());
  }
}

TEST_F(PanesTest, AnotherWindowsStudyIsNotShown) {
  const Inspection inspection = made_inspection({.estimate_error = 1});
  open(inspection);
  state_.view.panes.side = find_side_pane("normals");
  NormalStudy other = *made_study(inspection);
  other.window = std::make_shared<const Window>(*inspection.window);
  state_.results.study = std::make_shared<const NormalStudy>(other);
  draw();
  EXPECT_EQ(views_->normals.texture().revision(), 0U);
}

TEST_F(PanesTest, TimesAreLeftOutOfImages) {
  Inspection inspection = made_inspection();
  state_.view.panes.drawer = find_drawer("timing");
  for (const bool timings : {false, true}) {
    timings_ = timings;
    inspection.timing = {100, 20, 3, 40, 30, 163};
    open(inspection);
    const cv::Mat first = drawer_image();
    std::filesystem::create_directories(GPO_TEST_OUTPUT_DIR);
    cv::imwrite(GPO_TEST_OUTPUT_DIR "/timing.png", first);
    inspection.timing = {10, 220, 33, 4, 3, 270};
    open(inspection);
    EXPECT_EQ(same_bytes(first, drawer_image()), !timings);
  }
}

}  // namespace
}  // namespace gpo
