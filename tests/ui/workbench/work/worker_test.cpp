// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/worker.h"

#include "engine/base/error.h"

#include <atomic>
#include <semaphore>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

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

  static void wait(const Worker& worker) {
    while (worker.status().busy) std::this_thread::yield();
  }
  static void open_and_wait(Worker& worker, const std::filesystem::path& path = "desk") {
    worker.open(path);
    wait(worker);
  }
  static void request_and_wait(Worker& worker, int start) {
    worker.request({.start = start});
    wait(worker);
  }
  Worker::Open opener() {
    return [this](const std::filesystem::path& path, const auto&...) { return open(path); };
  }

  std::atomic<bool> hold_ = false;
  std::atomic<bool> let_go_ = false;
  std::atomic<bool> calibration_fails_ = false;
  std::counting_semaphore<> begun_{0};
  std::vector<int> started_;  ///< touched by the worker's thread; read when it is idle
};

TEST_F(WorkerTest, PublishesTheOpenedRecordingAndThenItsInspection) {
  Worker worker(opener());
  EXPECT_FALSE(worker.status().busy);
  EXPECT_EQ(worker.latest().recording, nullptr);
  open_and_wait(worker);
  ASSERT_NE(worker.latest().recording, nullptr);
  EXPECT_EQ(worker.latest().recording->name, "desk");
  EXPECT_EQ(worker.latest().inspection, nullptr);
  const auto generation = worker.latest().generation;
  request_and_wait(worker, 7);
  ASSERT_NE(worker.latest().inspection, nullptr);
  EXPECT_EQ(worker.latest().inspection->settings.start, 7);
  EXPECT_GT(worker.latest().generation, generation);
}

TEST_F(WorkerTest, LatestRequestStopsTheRunningOne) {
  Worker worker(opener());
  open_and_wait(worker);
  hold_ = true;
  worker.request({.start = 1});
  begun_.acquire();
  worker.request({.start = 2});  // stops 1, which would never end
  begun_.acquire();
  worker.request({.start = 3});
  worker.request({.start = 4});
  let_go_ = true;
  wait(worker);
  EXPECT_EQ(worker.latest().inspection->settings.start, 4);
  EXPECT_EQ(worker.latest().generation, 2u);  // only the recording and the latest request
  EXPECT_EQ(started_.front(), 1);
  EXPECT_EQ(started_.back(), 4);
}

TEST_F(WorkerTest, ReportsStageAndProgressWhileBusy) {
  Worker worker(opener());
  open_and_wait(worker);
  hold_ = true;
  worker.request({.start = 41});
  begun_.acquire();
  const JobStatus status = worker.status();
  EXPECT_TRUE(status.busy);
  EXPECT_EQ(status.stage, "tracking");
  EXPECT_EQ(status.done, 41);
  EXPECT_EQ(status.of, 60);
  let_go_ = true;
  wait(worker);
  EXPECT_THAT(worker.status().stage, IsEmpty());
}

TEST_F(WorkerTest, CancelStopsTheRunningRequestAndKeepsTheLastResult) {
  Worker worker(opener());
  open_and_wait(worker);
  request_and_wait(worker, 5);
  begun_.acquire();
  hold_ = true;
  worker.request({.start = 6});
  begun_.acquire();
  ASSERT_EQ(worker.status().stage, "tracking");
  worker.cancel();
  wait(worker);
  EXPECT_EQ(worker.latest().inspection->settings.start, 5);
  const JobStatus status = worker.status();
  EXPECT_THAT(status.error, IsEmpty());
  EXPECT_THAT(status.stage, IsEmpty());
  EXPECT_EQ(status.done, 0);
  EXPECT_EQ(status.of, 0);
}

TEST_F(WorkerTest, ReportsTheErrorOfARequestUntilTheNextOne) {
  Worker worker(opener());
  open_and_wait(worker);
  request_and_wait(worker, 13);
  EXPECT_EQ(worker.status().error, "start: 13 is beyond the end");
  EXPECT_EQ(worker.latest().inspection, nullptr);
  request_and_wait(worker, 1);
  EXPECT_THAT(worker.status().error, IsEmpty());
}

TEST_F(WorkerTest, FailedOpeningKeepsTheOldRecording) {
  Worker worker(opener());
  open_and_wait(worker);
  open_and_wait(worker, "bad");
  EXPECT_EQ(worker.status().error, "bad/camera.yaml: no such file");
  EXPECT_EQ(worker.latest().recording->name, "desk");
  open_and_wait(worker, "bug");
  EXPECT_EQ(worker.status().error, "internal error, please report it: a bug");
}

TEST_F(WorkerTest, OpeningARecordingDiscardsTheOldInspection) {
  Worker worker(opener());
  open_and_wait(worker);
  request_and_wait(worker, 5);
  open_and_wait(worker, "floor");
  EXPECT_EQ(worker.latest().recording->name, "floor");
  EXPECT_EQ(worker.latest().inspection, nullptr);
}

TEST_F(WorkerTest, RequestWithoutARecordingIsIgnored) {
  Worker worker(opener());
  worker.request({.start = 1});
  EXPECT_FALSE(worker.status().busy);
  EXPECT_EQ(worker.latest().generation, 0u);
}

TEST_F(WorkerTest, CallsBackAfterEachPublication) {
  std::atomic<int> calls = 0;
  {
    Worker worker(opener(), [&] { ++calls; });
    open_and_wait(worker);
    request_and_wait(worker, 1);
  }
  EXPECT_EQ(calls, 4);  // opening, opened, tracking, finished
}

TEST_F(WorkerTest, CanBeDestroyedWhileBusy) {
  {
    Worker worker(opener());
    open_and_wait(worker);
    hold_ = true;
    worker.request({.start = 1});
    begun_.acquire();
  }
  EXPECT_THAT(started_, ElementsAre(1));
}

TEST_F(WorkerTest, PublishesTheCalibratedRecording) {
  Worker worker(opener());
  worker.calibrate();
  EXPECT_FALSE(worker.status().busy) << "no recording is open";
  open_and_wait(worker);
  worker.calibrate();
  wait(worker);
  EXPECT_EQ(worker.latest().recording->name, "calibrated");
  request_and_wait(worker, 2);
  EXPECT_EQ(worker.latest().inspection->settings.start, 2);
}

TEST_F(WorkerTest, CalibrationReportsProgressAndCanBeCanceled) {
  Worker worker(opener());
  open_and_wait(worker);
  hold_ = true;
  worker.calibrate();
  begun_.acquire();
  EXPECT_EQ(worker.status().stage, "calibrating: following a plane");
  EXPECT_EQ(worker.status().of, 8);
  worker.cancel();
  wait(worker);
  EXPECT_EQ(worker.latest().recording->name, "desk");
  EXPECT_EQ(worker.status().error, "");
}

TEST_F(WorkerTest, FailedCalibrationKeepsRequestsMadeMeanwhile) {
  Worker worker(opener());
  open_and_wait(worker);
  hold_ = true;
  calibration_fails_ = true;
  worker.calibrate();
  begun_.acquire();
  worker.request({.start = 3});
  hold_ = false;
  wait(worker);
  EXPECT_EQ(worker.latest().recording->name, "desk");
  ASSERT_NE(worker.latest().inspection, nullptr);
  EXPECT_EQ(worker.latest().inspection->settings.start, 3);
}

TEST_F(WorkerTest, ReportsWhyCalibrationFailed) {
  Worker worker(opener());
  open_and_wait(worker);
  calibration_fails_ = true;
  worker.calibrate();
  wait(worker);
  EXPECT_EQ(worker.status().error, "not enough motion");
}

}  // namespace
}  // namespace gpo
