// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/worker.h"

#include "engine/base/error.h"
#include "engine/window/window.h"
#include "tests/engine/desk.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <semaphore>
#include <thread>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::ElementsAre, testing::IsEmpty;

/// A worker whose jobs signal their start and, while `hold_` is set, run until they are stopped or
/// `let_go_` is set. Does not depend on time.
class WorkerTest : public testing::Test {
 protected:
  ~WorkerTest() override { let_go_ = true; }

  Worker::Opened open(const std::filesystem::path& path) {
    if (path == "bad") throw InputError("bad/camera.yaml: no such file");
    if (path == "bug") throw std::runtime_error("a bug");
    auto recording = std::make_shared<Recording>();
    recording->name = path.string();
    return {
        recording,
        [this](const Settings& settings, const std::stop_token& stop, const Progress& say) {
          return compute(settings, stop, say);
        },
        [this](const std::stop_token& stop, const Progress& say) { return calibrate(stop, say); }};
  }

  void begin_and_hold(const std::stop_token& stop) {
    begun_.release();
    while (hold_ && !let_go_ && !stop.stop_requested()) std::this_thread::yield();
  }
  Worker::Opened calibrate(const std::stop_token& stop, const Progress& progress) {
    progress("following a plane", 1, 8);
    begin_and_hold(stop);
    if (calibration_fails_) throw InputError("not enough motion");
    return stop.stop_requested() ? Worker::Opened{} : open("calibrated");
  }

  std::shared_ptr<const Inspection> compute(const Settings& settings,
                                            const std::stop_token& stop,
                                            const Progress& progress) {
    started_.push_back(settings.start);
    progress("tracking", settings.start, 60);
    begin_and_hold(stop);
    if (settings.start == 13) throw InputError("start: 13 is beyond the end");
    if (stop.stop_requested()) return nullptr;
    auto inspection = std::make_shared<Inspection>();
    inspection->settings = settings;
    return inspection;
  }

  void wait() {
    while (worker_->status().busy) std::this_thread::yield();
  }
  void open_and_wait(const std::filesystem::path& path = "desk") {
    worker_->open(path);
    wait();
  }
  /// Requests an inspection that runs until it is stopped, and waits for its beginning.
  void request_and_hold(int start) {
    hold_ = true;
    worker_->request({.start = start});
    begun_.acquire();
  }
  void request_and_wait(int start) {
    worker_->request({.start = start});
    wait();
  }

  std::atomic<bool> hold_ = false;
  std::atomic<bool> let_go_ = false;
  std::atomic<bool> calibration_fails_ = false;
  std::counting_semaphore<> begun_{0};
  std::vector<int> started_;  ///< touched by the worker's thread; read when it is idle
  std::atomic<int> calls_ = 0;
  std::optional<Worker> worker_{
      std::in_place,
      [this](const std::filesystem::path& path, const auto&...) { return open(path); },
      [this] { ++calls_; }};
};

TEST_F(WorkerTest, PublishesTheOpenedRecordingAndThenItsInspection) {
  worker_->request({.start = 1});  // ignored without a recording
  EXPECT_FALSE(worker_->status().busy);
  EXPECT_EQ(worker_->latest().recording, nullptr);
  EXPECT_EQ(worker_->latest().generation, 0u);
  open_and_wait();
  ASSERT_NE(worker_->latest().recording, nullptr);
  EXPECT_EQ(worker_->latest().recording->name, "desk");
  EXPECT_EQ(worker_->latest().inspection, nullptr);
  const auto generation = worker_->latest().generation;
  request_and_wait(7);
  ASSERT_NE(worker_->latest().inspection, nullptr);
  EXPECT_EQ(worker_->latest().inspection->settings.start, 7);
  EXPECT_GT(worker_->latest().generation, generation);
}

TEST_F(WorkerTest, LatestRequestStopsTheRunningOne) {
  open_and_wait();
  request_and_hold(1);
  worker_->request({.start = 2});  // stops 1, which would never end
  begun_.acquire();
  worker_->request({.start = 3});
  worker_->request({.start = 4});
  let_go_ = true;
  wait();
  EXPECT_EQ(worker_->latest().inspection->settings.start, 4);
  EXPECT_EQ(worker_->latest().generation, 2u);  // only the recording and the latest request
  EXPECT_EQ(started_.front(), 1);
  EXPECT_EQ(started_.back(), 4);
}

TEST_F(WorkerTest, ReportsStageAndProgressWhileBusy) {
  open_and_wait();
  request_and_hold(41);
  const JobStatus status = worker_->status();
  EXPECT_TRUE(status.busy);
  EXPECT_EQ(status.stage, "tracking");
  EXPECT_EQ(status.done, 41);
  EXPECT_EQ(status.of, 60);
  let_go_ = true;
  wait();
  EXPECT_THAT(worker_->status().stage, IsEmpty());
}

TEST_F(WorkerTest, CancelStopsTheRunningRequestAndKeepsTheLastResult) {
  open_and_wait();
  request_and_wait(5);
  begun_.acquire();
  request_and_hold(6);
  ASSERT_EQ(worker_->status().stage, "tracking");
  worker_->cancel(worker_->latest().recording);
  wait();
  EXPECT_EQ(worker_->latest().inspection->settings.start, 5);
  const JobStatus status = worker_->status();
  EXPECT_EQ(status.error + status.stage, "");
  EXPECT_TRUE(status.done == 0 && status.of == 0);
}

TEST_F(WorkerTest, ReportsTheErrorOfARequestUntilTheNextOne) {
  open_and_wait();
  request_and_wait(13);
  EXPECT_EQ(worker_->status().error, "start: 13 is beyond the end");
  EXPECT_EQ(worker_->latest().inspection, nullptr);
  request_and_wait(1);
  EXPECT_THAT(worker_->status().error, IsEmpty());
}

TEST_F(WorkerTest, FailedOpeningKeepsTheOldRecording) {
  open_and_wait();
  open_and_wait("bad");
  EXPECT_EQ(worker_->status().error, "bad/camera.yaml: no such file");
  EXPECT_EQ(worker_->latest().recording->name, "desk");
  open_and_wait("bug");
  EXPECT_EQ(worker_->status().error, "internal error, please report it: a bug");
}

TEST_F(WorkerTest, OpeningARecordingDiscardsTheOldInspection) {
  open_and_wait();
  request_and_wait(5);
  open_and_wait("floor");
  EXPECT_EQ(worker_->latest().recording->name, "floor");
  EXPECT_EQ(worker_->latest().inspection, nullptr);
}

TEST_F(WorkerTest, CallsBackAfterEachPublication) {
  open_and_wait();
  request_and_wait(1);
  worker_.reset();
  EXPECT_EQ(calls_, 4);  // opening, opened, tracking, finished
}

TEST_F(WorkerTest, CanBeDestroyedWhileBusy) {
  open_and_wait();
  request_and_hold(1);
  worker_.reset();
  EXPECT_THAT(started_, ElementsAre(1));
}

TEST_F(WorkerTest, PublishesTheCalibratedRecording) {
  worker_->calibrate();
  EXPECT_FALSE(worker_->status().busy) << "no recording is open";
  open_and_wait();
  worker_->calibrate();
  wait();
  EXPECT_EQ(worker_->latest().recording->name, "calibrated");
  request_and_wait(2);
  EXPECT_EQ(worker_->latest().inspection->settings.start, 2);
}

TEST_F(WorkerTest, CalibrationReportsProgressAndCanBeCanceled) {
  open_and_wait();
  hold_ = true;
  worker_->calibrate();
  begun_.acquire();
  EXPECT_EQ(worker_->status().stage, "calibrating: following a plane");
  EXPECT_EQ(worker_->status().of, 8);
  worker_->cancel(worker_->latest().recording);
  wait();
  EXPECT_EQ(worker_->latest().recording->name, "desk");
  EXPECT_EQ(worker_->status().error, "");
}

TEST_F(WorkerTest, FailedCalibrationKeepsRequestsMadeMeanwhile) {
  open_and_wait();
  hold_ = true;
  calibration_fails_ = true;
  worker_->calibrate();
  begun_.acquire();
  worker_->request({.start = 3});
  hold_ = false;
  wait();
  EXPECT_EQ(worker_->latest().recording->name, "desk");
  ASSERT_NE(worker_->latest().inspection, nullptr);
  EXPECT_EQ(worker_->latest().inspection->settings.start, 3);
}

TEST_F(WorkerTest, ReportsWhyCalibrationFailed) {
  open_and_wait();
  calibration_fails_ = true;
  worker_->calibrate();
  wait();
  EXPECT_EQ(worker_->status().error, "not enough motion");
}

using test::desk;

std::shared_ptr<const Inspection> inspection_of(const std::shared_ptr<const Recording>& recording,
                                                int frames) {
  Inspection inspection;
  inspection.recording = recording;
  inspection.window = std::make_shared<const Window>(test::simulate({.frames = frames}).window);
  return std::make_shared<const Inspection>(inspection);
}

void settle(const auto& job) {
  while (job.status().busy) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(SurveyStudy, BelongsToTheLastRequestedWindow) {
  const auto recording = std::make_shared<const Recording>();
  const auto first = inspection_of(recording, 20), second = inspection_of(recording, 8);
  Survey survey;
  survey.open(recording);
  EXPECT_EQ(survey.latest_study(), nullptr);
  survey.study(first);
  EXPECT_TRUE(survey.status().busy);
  EXPECT_FALSE(survey.status().stage.empty());
  survey.study(second);
  settle(survey);
  ASSERT_NE(survey.latest_study(), nullptr);
  EXPECT_EQ(survey.latest_study()->window, second->window);
  const auto study = survey.latest_study();
  survey.study(second);
  EXPECT_FALSE(survey.status().busy) << "already studied";
  EXPECT_EQ(survey.latest_study(), study);
}

TEST(SurveyStudy, StopsOnRequestAndIsDiscardedWithItsRecording) {
  const auto recording = std::make_shared<const Recording>();
  const auto inspection = inspection_of(recording, 8);
  Survey survey;
  survey.open(recording);
  survey.study(inspection_of(recording, 60));
  survey.study(nullptr);
  EXPECT_FALSE(survey.status().busy);
  survey.study(inspection);
  settle(survey);
  ASSERT_NE(survey.latest_study(), nullptr);
  survey.open(std::make_shared<const Recording>());
  EXPECT_EQ(survey.latest_study(), nullptr);
  survey.study(inspection);
  EXPECT_FALSE(survey.status().busy) << "of another recording";
}

TEST(SurveyStudy, FailureIsKeptWithItsReasonAndNotRetried) {
  const auto recording = std::make_shared<const Recording>();
  const auto first = inspection_of(recording, 8), second = inspection_of(recording, 6);
  std::atomic<int> tried = 0;
  Survey survey({}, [&](const Inspection&, const std::stop_token&) {
    ++tried;
    throw InputError("no frame has enough tracks");
    return std::shared_ptr<const NormalStudy>();
  });
  survey.open(recording);
  survey.study(first);
  settle(survey);
  ASSERT_NE(survey.latest_study(), nullptr);
  EXPECT_EQ(survey.latest_study()->window, first->window);
  EXPECT_EQ(survey.latest_study()->error, "no frame has enough tracks");
  survey.study(first);
  EXPECT_FALSE(survey.status().busy) << "it would fail again";
  EXPECT_EQ(tried, 1);
  survey.study(second);
  settle(survey);
  EXPECT_EQ(survey.latest_study()->window, second->window);
  EXPECT_EQ(tried, 2);
}

TEST(ScanInTheBackground, FindsAllStartsAndCachesThem) {
  Scan scan;
  EXPECT_EQ(scan.latest(), nullptr);
  const Settings longer{.start = 7, .frames = desk()->frame_count() - 3};
  const Settings shorter{.frames = desk()->frame_count() - 1};
  scan.want(desk(), longer);
  EXPECT_TRUE(scan.status().busy);
  settle(scan);
  const auto first = scan.latest();
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(first->starts.size(), 4U);
  EXPECT_TRUE(std::ranges::is_sorted(first->starts, {}, &ScannedStart::start));
  scan.want(desk(), shorter);
  EXPECT_EQ(scan.latest()->of, 2);
  settle(scan);
  Settings of_one_start{.start = 2, .frames = longer.frames, .exclude = {17}};
  of_one_start.mask.areas = {{.corners_raw_px = {{0, 0}, {100, 100}}}};
  scan.want(desk(), of_one_start);
  EXPECT_EQ(scan.latest(), first) << "start, excluded tracks and masks of the settings are ignored";
  EXPECT_FALSE(scan.status().busy);
  scan.want(nullptr, std::nullopt);
  EXPECT_EQ(scan.latest(), nullptr);
}

TEST(ScanInTheBackground, StopsAtOnceOnRequest) {
  Scan scan;
  scan.want(desk(), Settings{.frames = 20});
  while (scan.status().done == 0) std::this_thread::yield();
  scan.want(desk(), std::nullopt);
  EXPECT_FALSE(scan.status().busy);
  scan.want(desk(), Settings{.frames = desk()->frame_count() + 1});
  EXPECT_FALSE(scan.status().busy) << "no window fits";
  EXPECT_EQ(scan.latest()->of, 0);
}

}  // namespace
}  // namespace gpo
