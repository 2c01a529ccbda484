// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/gl_test.h"
#include "tests/ui/made_inspection.h"
#include "ui/context/offscreen_context.h"
#include "ui/workbench_window.h"

#include <memory>

#include <gtest/gtest.h>
#include <imgui.h>

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
    state_.settings = inspection.settings;
    adopt(state_, inspection.recording);
    state_.inspection = std::make_shared<const Inspection>(inspection);
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
    return window_layout(kWidth, kHeight, 1, state_.panes.drawer.has_value());
  }
  cv::Mat drawer_picture() {
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
  WorkerStatus idle_;
  SurveyStatus no_survey_;
  bool timings_ = true;
};

TEST_F(PanesTest, DrawWhateverIsKnown) {
  for (const bool ok : {true, false}) {
    Inspection inspection = made_inspection({.ok = ok});
    open(inspection);
    for (const auto pane : {SidePane::normals, SidePane::solver, SidePane::candidates})
      for (const auto drawer : {Drawer::residuals, Drawer::timing}) {
        state_.panes.side = pane;
        state_.panes.drawer = drawer;
        draw();
        EXPECT_TRUE(draw().empty());
      }
    state_.inspection.reset();
    draw();
  }
}

TEST_F(PanesTest, ClickInTheFramesOfTheResidualsGoesThere) {
  open(made_inspection({.estimate_error = 1}));
  state_.panes.drawer = Drawer::residuals;
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
  state_.panes.drawer = Drawer::residuals;
  draw();
  const std::size_t drawn = views_->charts.at("rms over frames").revision();
  apply(state_, GoToFrame{20});
  draw();
  EXPECT_EQ(views_->charts.at("rms over frames").revision(), drawn)
      << "the cursor is drawn over it";
  EXPECT_EQ(views_->residuals.of, state_.inspection);
}

TEST_F(PanesTest, TimesAreLeftOutOfPictures) {
  Inspection inspection = made_inspection();
  state_.panes.drawer = Drawer::timing;
  for (const bool timings : {false, true}) {
    timings_ = timings;
    inspection.timing = {100, 20, 3, 40, 30, 163};
    open(inspection);
    const cv::Mat first = drawer_picture();
    inspection.timing = {10, 220, 33, 4, 3, 270};
    open(inspection);
    EXPECT_EQ(same_bytes(first, drawer_picture()), !timings);
  }
}

}  // namespace
}  // namespace gpo
