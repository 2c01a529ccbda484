// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/window_test.h"

#include <mutex>
#include <semaphore>
#include <thread>

#include <gmock/gmock.h>

namespace gpo {
namespace {

/// A window over a recording whose images are decoded only when the test releases them.
class WaitingImage : public test::WindowTest {
 protected:
  WaitingImage() {
    Inspection inspection = made_inspection();
    auto recording = std::make_shared<Recording>(*inspection.recording);
    recording->images = std::make_shared<const FrameCache>(
        recording->frame_count(), [this](int frame) { return decode(frame); });
    inspection.recording = recording;
    inspection_ = std::make_shared<const Inspection>(inspection);
    test::open(state_, inspection_);
    apply(state_, RunAction{"select track " + std::to_string(inspection_->tracks->ids[3])});
    timings_ = false;
    fetching_ = &fetcher_;
  }
  ~WaitingImage() override { released_.release(1000); }

  cv::Mat decode(int frame) {
    {
      const std::scoped_lock lock(mutex_);
      by_window_ = by_window_ || std::this_thread::get_id() == window_;
    }
    released_.acquire();
    return {480, 640, CV_8UC3, cv::Scalar::all(frame)};
  }
  void release(int images) {
    released_.release(images);
    for (int i = 0; i < images; ++i) fetched_.acquire();
  }
  void draw_frame(int frame) {
    apply(state_, GoToFrame{frame});
    draw();
  }

  const std::thread::id window_ = std::this_thread::get_id();
  std::counting_semaphore<> released_{0}, fetched_{0};
  std::mutex mutex_;
  bool by_window_ = false;
  ImageFetcher fetcher_{[this] { fetched_.release(); }};
};

TEST_F(WaitingImage, DrawsWithoutTheImageUntilItIsFetched) {
  draw();
  EXPECT_EQ(views_->image.revision(), 0U);
  EXPECT_EQ(shown_image(*views_), nullptr);
  const cv::Mat before = context_.read_bgr();
  release(1);
  draw();
  EXPECT_EQ(views_->image.revision(), 1U);
  EXPECT_EQ(views_->frame, state_.view.frame);
  EXPECT_FALSE(same_bytes(context_.read_bgr(), before));
  EXPECT_FALSE(by_window_) << "the window's thread must not decode";
}

TEST_F(WaitingImage, KeepsTheLastImageUntilTheNextIsFetched) {
  draw();
  release(1);
  draw();
  const int before = state_.view.frame;
  draw_frame(before - 5);
  EXPECT_EQ(views_->frame, before);
  EXPECT_NE(shown_image(*views_), nullptr);
  release(1);
  draw();
  EXPECT_EQ(views_->frame, before - 5);
  EXPECT_FALSE(by_window_);
}

TEST_F(WaitingImage, ShowsALateImageDuringPlayback) {
  const int first = state_.document.settings.start;
  for (int i = 0; i <= 3; ++i) draw_frame(first + i);
  release(1);
  draw();
  EXPECT_EQ(views_->frame, first);
  release(1);
  draw();
  EXPECT_EQ(views_->frame, first + 3);
}

TEST_F(WaitingImage, FetchesPatchesAndColumnsInTheBackground) {
  for (const char* view : {"view track", "view compare"}) {
    apply(state_, RunAction{view});
    draw();
  }
  EXPECT_TRUE(views_->patches[0].empty);
  release(3);  // the current frame's, and the track's first and last
  draw();
  EXPECT_NE(shown_image(*views_), nullptr);
  EXPECT_FALSE(views_->patches[0].empty);
  EXPECT_FALSE(views_->patches[1].empty);
  EXPECT_FALSE(by_window_);
}

TEST_F(WaitingImage, DecodesInTheWindowsThreadWithoutAFetcher) {
  released_.release(10);
  fetching_ = nullptr;
  draw();
  EXPECT_EQ(views_->image.revision(), 1U);
  EXPECT_TRUE(by_window_);
}

TEST_F(WaitingImage, ComputesTheLifeOfATrackOnce) {
  released_.release(1000);
  for (const char* drawer : {"view track", "view residuals"}) {
    apply(state_, RunAction{drawer});
    for (int i = 0; i < 3; ++i) draw();
  }
  EXPECT_EQ(views_->lives.computed(), 1U);
  apply(state_, RunAction{"previous"});
  draw();
  EXPECT_EQ(views_->lives.computed(), 1U);
}

}  // namespace
}  // namespace gpo
