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

/// A worker whose computation the test holds by the hand: it starts, tells so, and ends when it is
/// let go or stopped. No clock is asked.
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

  Worker::Opened calibrate(const std::stop_token& stop, const Progress& progress) {
    progress("following a plane", 1, 8);
    begun_.release();
    while (hold_ && !let_go_ && !stop.stop_requested()) std::this_thread::yield();
    if (calibration_fails_) throw InputError("the motion cannot tell");
    return stop.stop_requested() ? Worker::Opened{} : open("calibrated");
  }

  std::shared_ptr<const Inspection> compute(const Settings& settings,
                                            const std::stop_token& stop,
                                            const Progress& progress) {
    started_.push_back(settings.start);
    progress("tracking", settings.start, 60);
    begun_.release();
    while (hold_ && !let_go_ && !stop.stop_requested()) std::this_thread::yield();
    if (settings.start == 13) throw InputError("start: 13 is beyond the end");
    if (stop.stop_requested()) return nullptr;
    auto inspection = std::make_shared<Inspection>();
    inspection->settings = settings;
    return inspection;
  }

  void wait_until_idle(const Worker& worker) {
    while (worker.status().busy) std::this_thread::yield();
  }
  void open_and_wait(Worker& worker, const std::filesystem::path& path = "desk") {
    worker.open(path);
    wait_until_idle(worker);
  }
  static Settings start_at(int start) { return {.start = start}; }
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
  worker.request(start_at(7));
  wait_until_idle(worker);
  ASSERT_NE(worker.latest().inspection, nullptr);
  EXPECT_EQ(worker.latest().inspection->settings.start, 7);
  EXPECT_GT(worker.latest().generation, generation);
}

TEST_F(WorkerTest, NewestRequestWinsAndStopsTheRunningOne) {
  Worker worker(opener());
  open_and_wait(worker);
  hold_ = true;
  worker.request(start_at(1));
  begun_.acquire();
  worker.request(start_at(2));  // stops 1, which never ends by itself
  begun_.acquire();
  worker.request(start_at(3));
  worker.request(start_at(4));
  let_go_ = true;
  wait_until_idle(worker);
  EXPECT_EQ(worker.latest().inspection->settings.start, 4);
  EXPECT_EQ(worker.latest().generation, 2u);  // the recording and the newest request, no other
  EXPECT_EQ(started_.front(), 1);
  EXPECT_EQ(started_.back(), 4);
}

TEST_F(WorkerTest, TellsStageAndProgressWhileBusy) {
  Worker worker(opener());
  open_and_wait(worker);
  hold_ = true;
  worker.request(start_at(41));
  begun_.acquire();
  const JobStatus status = worker.status();
  EXPECT_TRUE(status.busy);
  EXPECT_EQ(status.stage, "tracking");
  EXPECT_EQ(status.done, 41);
  EXPECT_EQ(status.of, 60);
  let_go_ = true;
  wait_until_idle(worker);
  EXPECT_THAT(worker.status().stage, IsEmpty());
}

TEST_F(WorkerTest, CancelEndsTheRunningRequestAndKeepsTheLastResult) {
  Worker worker(opener());
  open_and_wait(worker);
  worker.request(start_at(5));
  wait_until_idle(worker);
  begun_.acquire();
  hold_ = true;
  worker.request(start_at(6));
  begun_.acquire();
  worker.cancel();
  wait_until_idle(worker);
  EXPECT_EQ(worker.latest().inspection->settings.start, 5);
  EXPECT_THAT(worker.status().error, IsEmpty());
}

TEST_F(WorkerTest, CancelForgetsTheStageOfWhatRan) {
  Worker worker(opener());
  open_and_wait(worker);
  hold_ = true;
  worker.request(start_at(41));
  begun_.acquire();
  ASSERT_EQ(worker.status().stage, "tracking");
  worker.cancel();
  wait_until_idle(worker);
  EXPECT_THAT(worker.status().stage, IsEmpty());
  EXPECT_EQ(worker.status().done, 0);
  EXPECT_EQ(worker.status().of, 0);
}

TEST_F(WorkerTest, ReportsTheErrorOfARequestUntilTheNextOne) {
  Worker worker(opener());
  open_and_wait(worker);
  worker.request(start_at(13));
  wait_until_idle(worker);
  EXPECT_EQ(worker.status().error, "start: 13 is beyond the end");
  EXPECT_EQ(worker.latest().inspection, nullptr);
  worker.request(start_at(1));
  wait_until_idle(worker);
  EXPECT_THAT(worker.status().error, IsEmpty());
}

TEST_F(WorkerTest, RecordingThatCannotBeOpenedLeavesTheOldOneAndSaysWhy) {
  Worker worker(opener());
  open_and_wait(worker);
  open_and_wait(worker, "bad");
  EXPECT_EQ(worker.status().error, "bad/camera.yaml: no such file");
  EXPECT_EQ(worker.latest().recording->name, "desk");
  open_and_wait(worker, "bug");
  EXPECT_EQ(worker.status().error, "internal error, please report it: a bug");
}

TEST_F(WorkerTest, OpeningAnotherRecordingDropsTheInspectionOfTheOld) {
  Worker worker(opener());
  open_and_wait(worker);
  worker.request(start_at(5));
  wait_until_idle(worker);
  open_and_wait(worker, "floor");
  EXPECT_EQ(worker.latest().recording->name, "floor");
  EXPECT_EQ(worker.latest().inspection, nullptr);
}

TEST_F(WorkerTest, RequestWithoutARecordingIsIgnored) {
  Worker worker(opener());
  worker.request(start_at(1));
  EXPECT_FALSE(worker.status().busy);
  EXPECT_EQ(worker.latest().generation, 0u);
}

TEST_F(WorkerTest, CallsBackAfterEachPublication) {
  std::atomic<int> calls = 0;
  {
    Worker worker(opener(), [&] { ++calls; });
    open_and_wait(worker);
    worker.request(start_at(1));
    wait_until_idle(worker);
  }
  EXPECT_EQ(calls, 4);  // opening, opened, tracking, finished
}

TEST_F(WorkerTest, CanBeDestroyedWhileItWorks) {
  {
    Worker worker(opener());
    open_and_wait(worker);
    hold_ = true;
    worker.request(start_at(1));
    begun_.acquire();
  }
  EXPECT_THAT(started_, ElementsAre(1));
}

TEST_F(WorkerTest, PublishesTheRecordingWithTheCameraThatItFinds) {
  Worker worker(opener());
  worker.calibrate();
  EXPECT_FALSE(worker.status().busy) << "nothing is open";
  open_and_wait(worker);
  worker.calibrate();
  wait_until_idle(worker);
  EXPECT_EQ(worker.latest().recording->name, "calibrated");
  worker.request(start_at(2));
  wait_until_idle(worker);
  EXPECT_EQ(worker.latest().inspection->settings.start, 2);
}

TEST_F(WorkerTest, ACalibrationTellsHowFarItIsAndCanBeCanceled) {
  Worker worker(opener());
  open_and_wait(worker);
  hold_ = true;
  worker.calibrate();
  begun_.acquire();
  EXPECT_EQ(worker.status().stage, "calibrating: following a plane");
  EXPECT_EQ(worker.status().of, 8);
  worker.cancel();
  wait_until_idle(worker);
  EXPECT_EQ(worker.latest().recording->name, "desk");
  EXPECT_EQ(worker.status().error, "");
}

TEST_F(WorkerTest, WhereNoCameraIsFoundTheOldOneComputesWhatWasAskedForMeanwhile) {
  Worker worker(opener());
  open_and_wait(worker);
  hold_ = true;
  calibration_fails_ = true;
  worker.calibrate();
  begun_.acquire();
  worker.request(start_at(3));
  hold_ = false;
  wait_until_idle(worker);
  EXPECT_EQ(worker.latest().recording->name, "desk");
  ASSERT_NE(worker.latest().inspection, nullptr);
  EXPECT_EQ(worker.latest().inspection->settings.start, 3);
}

TEST_F(WorkerTest, TellsWhyThereIsNoCamera) {
  Worker worker(opener());
  open_and_wait(worker);
  calibration_fails_ = true;
  worker.calibrate();
  wait_until_idle(worker);
  EXPECT_EQ(worker.status().error, "the motion cannot tell");
}

}  // namespace
}  // namespace gpo
