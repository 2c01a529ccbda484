// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/gl_test.h"
#include "tests/ui/made_inspection.h"
#include "ui/workbench/commands.h"
#include "ui/workbench/session/session_file.h"
#include "ui/workbench_window.h"

#include <mutex>
#include <semaphore>
#include <set>
#include <thread>

#include <gmock/gmock.h>

namespace gpo {
namespace {

/// A window over a recording whose pictures come only when the test lets them.
class WaitingImage : public DrawingTest {
 protected:
  static constexpr int kWidth = 1280, kHeight = 720;

  WaitingImage() {
    Inspection inspection = made_inspection();
    auto recording = std::make_shared<Recording>(*inspection.recording);
    recording->images = std::make_shared<const FrameCache>(
        recording->frame_count(), [this](int frame) { return decode(frame); });
    inspection.recording = recording;
    inspection_ = std::make_shared<const Inspection>(inspection);
    state_.document.settings = inspection_->settings;
    apply_recording(state_, recording);
    state_.results.inspection = inspection_;
    apply(state_, RunAction{"select track " + std::to_string(inspection_->tracks->ids[3])});
  }
  ~WaitingImage() override { let_go_.release(1000); }

  cv::Mat decode(int frame) {
    {
      const std::scoped_lock lock(mutex_);
      by_window_ = by_window_ || std::this_thread::get_id() == window_;
    }
    let_go_.acquire();
    return {480, 640, CV_8UC3, cv::Scalar::all(frame)};
  }
  void draw() {
    context_.bind();
    draw_workbench({state_, idle_, no_survey_, false, gui_.scale(), nullptr, nullptr, &fetcher_},
                   {kWidth, kHeight},
                   gui_,
                   views_);
  }
  void let_come(int images) {
    let_go_.release(images);
    for (int i = 0; i < images; ++i) come_.acquire();
  }

  const std::thread::id window_ = std::this_thread::get_id();
  std::counting_semaphore<> let_go_{0}, come_{0};
  std::mutex mutex_;
  bool by_window_ = false;
  OffscreenContext context_{kWidth, kHeight};
  Gui gui_;
  Views views_;
  std::shared_ptr<const Inspection> inspection_;
  WorkbenchState state_;
  JobStatus idle_;
  SurveyStatus no_survey_;
  ImageFetcher fetcher_{[this] { come_.release(); }};
};

TEST_F(WaitingImage, TheWindowIsDrawnWithoutItAndAgainWhenItComes) {
  draw();
  EXPECT_EQ(views_.image.revision(), 0U);
  EXPECT_EQ(shown_image(views_), nullptr);
  const cv::Mat before = context_.read_bgr();
  let_come(1);
  draw();
  EXPECT_EQ(views_.image.revision(), 1U);
  EXPECT_EQ(views_.frame, state_.view.frame);
  EXPECT_FALSE(same_bytes(context_.read_bgr(), before));
  EXPECT_FALSE(by_window_) << "the window's thread decodes nothing";
}

TEST_F(WaitingImage, TheLastOneStaysWithItsOwnFrameUntilTheNextHasCome) {
  draw();
  let_come(1);
  draw();
  const int before = state_.view.frame;
  apply(state_, GoToFrame{before - 5});
  draw();
  EXPECT_EQ(views_.frame, before);
  EXPECT_NE(shown_image(views_), nullptr);
  let_come(1);
  draw();
  EXPECT_EQ(views_.frame, before - 5);
  EXPECT_FALSE(by_window_);
}

TEST_F(WaitingImage, WhatComesTooLateIsShownRatherThanNone) {
  const int first = state_.document.settings.start;
  apply(state_, GoToFrame{first});
  draw();
  for (int i = 1; i <= 3; ++i) {  // plays on meanwhile
    apply(state_, GoToFrame{first + i});
    draw();
  }
  let_come(1);
  draw();
  EXPECT_EQ(views_.frame, first);
  let_come(1);
  draw();
  EXPECT_EQ(views_.frame, first + 3);
}

TEST_F(WaitingImage, PatchesOfATrackAndColumnsComeLaterToo) {
  for (const char* view : {"view track", "view compare"}) {
    apply(state_, RunAction{view});
    draw();
  }
  EXPECT_TRUE(views_.patches[0].empty);
  let_come(3);  // the current frame's, and the track's first and last
  draw();
  EXPECT_NE(shown_image(views_), nullptr);
  EXPECT_FALSE(views_.patches[0].empty);
  EXPECT_FALSE(views_.patches[1].empty);
  EXPECT_FALSE(by_window_);
}

TEST_F(WaitingImage, WhoeverIsNotInAHurryWaitsForIt) {
  let_go_.release(10);
  context_.bind();
  draw_workbench({state_, idle_, no_survey_, false, gui_.scale()}, {kWidth, kHeight}, gui_, views_);
  EXPECT_EQ(views_.image.revision(), 1U);
  EXPECT_TRUE(by_window_);
}

TEST_F(WaitingImage, ATracksLifeIsComputedOnceHoweverOftenItIsDrawn) {
  let_go_.release(1000);
  for (const char* drawer : {"view track", "view residuals"}) {
    apply(state_, RunAction{drawer});
    for (int i = 0; i < 3; ++i) draw();
  }
  EXPECT_EQ(views_.lives.computed(), 1U);
  apply(state_, RunAction{"previous"});
  draw();
  EXPECT_EQ(views_.lives.computed(), 1U);
}

}  // namespace
}  // namespace gpo
