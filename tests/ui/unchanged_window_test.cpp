// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/gl_test.h"
#include "tests/ui/made_inspection.h"
#include "ui/workbench/commands.h"
#include "ui/workbench/session/session_file.h"
#include "ui/workbench_window.h"

#include <algorithm>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::IsEmpty;

/// What is drawn anew from one frame of the window to the next.
class UnchangedWindow : public DrawingTest {
 protected:
  static constexpr int kWidth = 1280, kHeight = 720;

  UnchangedWindow() {
    const auto inspection = std::make_shared<const Inspection>(made_inspection());
    state_.document.settings = inspection->settings;
    apply_recording(state_, inspection->recording);
    state_.results.inspection = inspection;
    for (int i = 0; i < 3; ++i) draw();  // sizes settle
  }
  void draw() {
    context_.bind();
    draw_workbench({state_, idle_, no_survey_}, {kWidth, kHeight}, gui_, views_);
  }
  bool redrawn(const Rectangle& place) const {
    const cv::Point middle(static_cast<int>(place.x + place.width / 2),
                           static_cast<int>(place.y + place.height / 2));
    return std::ranges::any_of(views_.window.redrawn(),
                               [&](const cv::Rect& part) { return part.contains(middle); });
  }

  OffscreenContext context_{kWidth, kHeight};
  Gui gui_;
  Views views_;
  WorkbenchState state_;
  JobStatus idle_;
  SurveyStatus no_survey_;
  WindowLayout layout_ = window_layout({kWidth, kHeight});
};

TEST_F(UnchangedWindow, IsNotDrawnAgain) {
  const std::size_t renders = views_.scene.renders();
  draw();
  EXPECT_THAT(views_.window.redrawn(), IsEmpty());
  EXPECT_EQ(views_.scene.renders(), renders);
}

TEST_F(UnchangedWindow, StepDrawsTheViewsButNotTheSettingsNorTheSceneAnew) {
  const std::size_t renders = views_.scene.renders();
  for (const int frame : {20, 21}) {
    apply(state_, GoToFrame{frame});
    draw();
    EXPECT_TRUE(redrawn(layout_.image));
    EXPECT_TRUE(redrawn(layout_.side));
    EXPECT_FALSE(redrawn(layout_.settings));
    const cv::Mat kept = context_.read_bgr();
    views_.window = WindowImage();  // all of it is drawn at once now
    draw();
    EXPECT_TRUE(same_bytes(kept, context_.read_bgr()));
  }
  EXPECT_EQ(views_.scene.renders(), renders);
}

TEST_F(UnchangedWindow, HiddenTracksAreGoneAtOnce) {
  state_.view.toggles.tracks = !state_.view.toggles.tracks;
  draw();
  EXPECT_TRUE(redrawn(layout_.image));
  EXPECT_FALSE(redrawn(layout_.side));
}

}  // namespace
}  // namespace gpo
