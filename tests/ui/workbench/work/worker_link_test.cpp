// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/worker_link.h"

#include "engine/base/error.h"
#include "tests/engine/desk.h"
#include "tests/engine/test_folder.h"
#include "ui/workbench/actions/apply.h"
#include "ui/workbench/session/recent_files.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A workbench with a worker whose computation only remembers what it was asked for, and lasts
/// until it is stopped while `hold` is set.
class WorkerLinkTest : public testing::Test {
 protected:
  Worker::Opened open(const std::filesystem::path& path) {
    if (path.filename() == "bad") throw InputError("bad: no such folder");
    auto recording = std::make_shared<Recording>();
    if (path == "pictures") *recording = *test::desk();
    recording->name = path.string();
    if (path == "pictures") return opened(recording);
    for (int i = 0; i < 60; ++i) recording->timestamps_ns.push_back(i * 33'000'000);
    if (path == "bare.mp4") {
      recording->camera_source = CameraSource::guess;
      recording->images = std::make_shared<const FrameCache>(60, [](int) { return cv::Mat(); });
    }
    return opened(recording);
  }
  Worker::Opened opened(const std::shared_ptr<Recording>& recording) {
    return {
        recording,
        [this, recording](const Settings& settings, const std::stop_token& stop, const Progress&) {
          {
            const std::lock_guard lock(mutex_);
            starts_.push_back(settings.start);
          }
          while (hold_ && !stop.stop_requested()) std::this_thread::yield();
          auto inspection = std::make_shared<Inspection>();
          inspection->recording = recording;
          inspection->settings = settings;
          return inspection;
        },
        [this, recording](const std::stop_token& stop, const Progress&) {
          while (hold_ && !stop.stop_requested()) std::this_thread::yield();
          if (stop.stop_requested()) return Worker::Opened{};
          Worker::Opened opened = open("desk");
          auto calibrated = std::make_shared<Recording>(*recording);
          calibrated->camera_source = CameraSource::self_calibrated;
          opened.recording = calibrated;
          return opened;
        }};
  }
  void synchronize() { gpo::synchronize(state_, link_, worker_, survey_, scan_, "example"); }
  void settle() {
    do {
      synchronize();
    } while (link_.worker.busy);
    synchronize();
  }
  std::vector<int> starts() {
    const std::lock_guard lock(mutex_);
    return starts_;
  }

  std::atomic<bool> hold_ = false;
  std::mutex mutex_;
  std::vector<int> starts_;
  WorkbenchState state_;
  WorkerLink link_;
  Survey survey_;
  Scan scan_;
  Worker worker_{[this](const std::filesystem::path& path, const auto&...) { return open(path); }};
};

TEST_F(WorkerLinkTest, ScansTheRecordingWhereSomebodyWantsThat) {
  apply(state_, OpenPath{"desk"});
  settle();
  EXPECT_EQ(state_.results.scan, nullptr);
  apply(state_, RunAction{"scan on"});
  while (synchronize(), link_.busy()) std::this_thread::yield();
  ASSERT_NE(state_.results.scan, nullptr);
  EXPECT_EQ(state_.results.scan->of, 31);
  ASSERT_EQ(state_.results.scan->starts.size(), 31U);
  EXPECT_FALSE(state_.results.scan->starts[7].ok);
  EXPECT_FALSE(state_.results.scan->starts[7].reason.empty())
      << "this recording has neither pictures "
         "nor tracks";
  apply(state_, RunAction{"scan off"});
  synchronize();
  EXPECT_EQ(state_.results.scan, nullptr);
}

TEST_F(WorkerLinkTest, FindsAStartAndGoesThere) {
  apply(state_, OpenPath{"pictures"});
  settle();
  apply(state_, RunAction{"set start 30"});
  settle();
  apply(state_, RunAction{"find-start"});
  while (synchronize(), link_.finding_start) std::this_thread::yield();
  settle();
  ASSERT_NE(state_.results.scan, nullptr);
  const ScannedStart* best = best_start(state_.results.scan->starts);
  ASSERT_NE(best, nullptr);
  EXPECT_EQ(best->readiness, Readiness::ready);
  EXPECT_TRUE(state_.messages.text.starts_with("starts at ")) << state_.messages.text;
  EXPECT_EQ(starts().back(), state_.document.settings.start);
  EXPECT_EQ(state_.view.frame,
            state_.document.settings.start + state_.document.settings.frames - 1);
  EXPECT_NE(state_.document.settings.start, 30);
  apply(state_, RunAction{"undo"});
  EXPECT_EQ(state_.document.settings.start, 30);
}

TEST_F(WorkerLinkTest, SaysWhereThereIsNoStart) {
  apply(state_, OpenPath{"desk"});
  settle();
  apply(state_, RunAction{"find-start"});
  EXPECT_TRUE(state_.view.toggles.scan);
  while (synchronize(), link_.busy()) std::this_thread::yield();
  EXPECT_EQ(state_.document.settings.start, 0);
  EXPECT_EQ(state_.messages.severity, Severity::warning);
  EXPECT_EQ(state_.messages.text,
            "no start can be initialized; the strip above the time line says why");
}

TEST_F(WorkerLinkTest, EscapeAndAHiddenStripEndTheSearchForAStart) {
  apply(state_, OpenPath{"pictures"});
  settle();
  const auto ends_with = [&](const char* frames, const char* action) {
    apply(state_, RunAction{frames});
    apply(state_, RunAction{"find-start"});
    synchronize();
    EXPECT_TRUE(link_.finding_start);
    apply(state_, RunAction{action});
    synchronize();
    EXPECT_FALSE(link_.finding_start) << action;
    settle();
  };
  ends_with("set frames 58", "escape");
  ends_with("set frames 57", "scan off");
}

TEST_F(WorkerLinkTest, OpeningARecordingInspectsItOnce) {
  apply(state_, OpenPath{"desk"});
  settle();
  ASSERT_NE(state_.document.recording, nullptr);
  EXPECT_EQ(state_.document.recording->name, "desk");
  EXPECT_EQ(state_.view.frame, 29);
  ASSERT_NE(state_.results.inspection, nullptr);
  EXPECT_EQ(state_.results.inspection->settings, state_.document.settings);
  settle();
  EXPECT_THAT(starts(), ElementsAre(0));
}

TEST_F(WorkerLinkTest, OpensTheExample) {
  apply(state_, RunAction{"open-example"});
  settle();
  EXPECT_EQ(state_.document.recording->name, "example");
}

TEST_F(WorkerLinkTest, RemembersWhatCouldBeOpened) {
  const test::TestFolder folder;
  setenv("XDG_STATE_HOME", folder.path().c_str(), 1);
  link_.remembers_files = true;
  for (const char* name : {"good", "bad", "better"}) {
    std::filesystem::create_directories(folder.path() / name);
    apply(state_, OpenPath{folder.path() / name});
    settle();
  }
  apply(state_, RunAction{"open-example"});
  settle();
  EXPECT_THAT(recent_files(), ElementsAre(folder.path() / "better", folder.path() / "good"));
}

TEST_F(WorkerLinkTest, ChangedSettingsAreInspectedAndUnchangedOnesAreNot) {
  apply(state_, OpenPath{"desk"});
  settle();
  apply(state_, GoToFrame{7});
  settle();
  EXPECT_THAT(starts(), ElementsAre(0));
  apply(state_, RunAction{"window-start"});
  settle();
  EXPECT_THAT(starts(), ElementsAre(0, 7));
  apply(state_, RunAction{"compute"});
  settle();
  EXPECT_THAT(starts(), ElementsAre(0, 7, 7));
}

TEST_F(WorkerLinkTest, EscapeStopsTheComputationAndKeepsTheLastResult) {
  apply(state_, OpenPath{"desk"});
  settle();
  hold_ = true;
  apply(state_, GoToFrame{7});
  apply(state_, RunAction{"window-start"});
  synchronize();
  EXPECT_TRUE(link_.worker.busy);
  apply(state_, RunAction{"escape"});
  settle();
  EXPECT_EQ(state_.results.inspection->settings.start, 0);
  EXPECT_EQ(state_.document.settings.start, 7);
  EXPECT_EQ(state_.messages.text, "canceled; F5 computes again");
}

TEST_F(WorkerLinkTest, WhatCannotBeOpenedLeavesTheOldRecordingAndSaysWhy) {
  apply(state_, OpenPath{"desk"});
  settle();
  apply(state_, OpenPath{"bad"});
  settle();
  EXPECT_EQ(state_.document.recording->name, "desk");
  EXPECT_EQ(link_.worker.error, "bad: no such folder");
  ASSERT_NE(state_.results.inspection, nullptr);
}

TEST_F(WorkerLinkTest, AStudyThatFailsIsSaidOnceAndNotAskedForAgain) {
  std::atomic<int> tried = 0;
  Survey survey({}, [&](const Inspection&, const std::stop_token&) {
    ++tried;
    throw InputError("no frame has enough tracks");
    return std::shared_ptr<const NormalStudy>();
  });
  const auto turn = [&] { gpo::synchronize(state_, link_, worker_, survey, scan_, "example"); };
  apply(state_, OpenPath{"desk"});
  do {
    turn();
  } while (link_.busy() || !state_.results.inspection);
  apply(state_, RunAction{"view candidates"});
  do {
    turn();
  } while (!state_.results.study);
  for (int i = 0; i < 5; ++i) turn();
  EXPECT_FALSE(link_.busy());
  EXPECT_EQ(tried, 1);
  const auto says_so = [](const LogLine& line) {
    return line.severity == Severity::error && line.text.ends_with("no frame has enough tracks");
  };
  EXPECT_EQ(std::ranges::count_if(state_.messages.lines, says_so), 1);
}

TEST_F(WorkerLinkTest, LeavesRequestsThatAreNotForTheWorker) {
  state_.requests.quit = state_.requests.compute = true;
  state_.requests.screenshots.push_back({});
  synchronize();
  EXPECT_TRUE(state_.requests.quit);
  EXPECT_EQ(state_.requests.screenshots.size(), 1U);
  EXPECT_FALSE(state_.requests.compute);
}

TEST_F(WorkerLinkTest, OneClickCalibratesAndKeepsFrameAndBookmarks) {
  apply(state_, OpenPath{"bare.mp4"});
  settle();
  apply(state_, GoToFrame{7});
  state_.document.bookmarks = {{7, "here"}};
  apply(state_, RunAction{"calibrate"});
  settle();
  EXPECT_EQ(state_.document.recording->camera_source, CameraSource::self_calibrated);
  EXPECT_EQ(state_.view.frame, 7);
  EXPECT_THAT(state_.document.bookmarks, ElementsAre(Bookmark{7, "here"}));
  ASSERT_NE(state_.results.inspection, nullptr);
}

TEST_F(WorkerLinkTest, ACanceledCalibrationLeavesTheGuess) {
  apply(state_, OpenPath{"bare.mp4"});
  settle();
  hold_ = true;
  apply(state_, RunAction{"calibrate"});
  synchronize();
  EXPECT_TRUE(link_.worker.busy);
  state_.requests.cancel = true;
  synchronize();
  EXPECT_EQ(state_.messages.text, "the calibration was canceled; nothing was kept");
  hold_ = false;
  settle();
  EXPECT_EQ(state_.document.recording->camera_source, CameraSource::guess);
}

TEST_F(WorkerLinkTest, CalibratesWhatIsOpenedWithAGuessWhereTheUserWantsIt) {
  link_.calibrates = true;
  apply(state_, OpenPath{"bare.mp4"});
  settle();
  EXPECT_EQ(state_.document.recording->camera_source, CameraSource::self_calibrated);
}

TEST_F(WorkerLinkTest, ACameraFromAFileStays) {
  apply(state_, OpenPath{"desk"});
  settle();
  apply(state_, RunAction{"calibrate"});
  EXPECT_FALSE(state_.requests.calibrate);
  EXPECT_THAT(state_.messages.text, testing::HasSubstr("calibrate: the recording has no pictures"));
}

}  // namespace
}  // namespace gpo
