// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "tests/engine/desk.h"
#include "tests/engine/test_folder.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/session/session_file.h"
#include "ui/workbench/work/worker.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <thread>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::ElementsAre, testing::IsEmpty;

/// The worker only records the requested starts. While `hold_`, its jobs last until stopped, and
/// the recording "slow" is not open.
class WorkerLinkTest : public testing::Test {
 protected:
  WorkerLinkTest() { link_.example = "example"; }
  Worker::Opened open(const std::filesystem::path& path) {
    if (path.filename() == "bad") throw InputError("bad: no such folder");
    while (path.filename() == "slow" && hold_) std::this_thread::yield();
    auto recording = std::make_shared<Recording>();
    if (path == "pictures") *recording = *test::desk();
    recording->name = path.string();
    if (path == "pictures") return opened(recording);
    for (int i = 0; i < 60; ++i) recording->timestamps_ns.push_back(i * 33'000'000);
    if (path == "long.mkv") return first_frames(recording);
    if (path == "bare.mp4") {
      recording->camera_source = CameraSource::guess;
      recording->images = std::make_shared<const FrameCache>(60, [](int) { return cv::Mat(); });
    }
    return opened(recording);
  }
  /// The first 60 of 900 frames.
  Worker::Opened first_frames(const std::shared_ptr<Recording>& recording) {
    recording->path = "long.mkv";
    recording->complete = false;
    Worker::Opened first = opened(recording);
    first.rest = [this, recording](const std::stop_token& stop, const Progress&) {
      hold(stop);
      auto whole = std::make_shared<Recording>(*recording);
      whole->complete = true;
      for (int i = 60; i < 900; ++i) whole->timestamps_ns.push_back(i * std::int64_t{33'000'000});
      return opened(whole);
    };
    return first;
  }
  Worker::Opened opened(const std::shared_ptr<Recording>& recording) {
    return {
        recording,
        [this, recording](const Settings& settings, const std::stop_token& stop, const Progress&) {
          {
            const std::lock_guard lock(mutex_);
            starts_.push_back(settings.start);
          }
          hold(stop);
          auto inspection = std::make_shared<Inspection>();
          inspection->recording = recording;
          inspection->settings = settings;
          return inspection;
        },
        [this, recording](const std::stop_token& stop, const Progress&) {
          hold(stop);
          if (stop.stop_requested()) return Worker::Opened{};
          Worker::Opened opened = open("desk");
          auto calibrated = std::make_shared<Recording>(*recording);
          calibrated->camera_source = CameraSource::self_calibrated;
          opened.recording = calibrated;
          return opened;
        }};
  }
  void hold(const std::stop_token& stop) {
    while (hold_ && !stop.stop_requested()) std::this_thread::yield();
  }
  void synchronize() { gpo::synchronize(state_, link_, worker_, survey_, scan_); }
  void run(const char* action) { apply(state_, RunAction{action}); }
  void run_once(const char* action) {
    run(action);
    synchronize();
  }
  void run_and_settle(const char* action) {
    run(action);
    settle();
  }
  void open_and_settle(const std::filesystem::path& path) {
    apply(state_, OpenPath{path});
    settle();
  }
  void settle() {
    do {
      synchronize();
    } while (link_.worker.busy || link_.reading.busy);
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

TEST_F(WorkerLinkTest, ShowsFirstFramesOfAVideoWhileItIsReadOn) {
  hold_ = true;
  apply(state_, OpenPath{"long.mkv"});
  while (synchronize(), !state_.document.recording) std::this_thread::yield();
  EXPECT_EQ(state_.frame_count(), 60);
  EXPECT_TRUE(link_.loading);
  go_to_frame(state_, 10);
  synchronize();
  EXPECT_THAT(starts(), IsEmpty());
  hold_ = false;
  settle();
  EXPECT_EQ(state_.frame_count(), 900);
  EXPECT_EQ(state_.view.frame, 10);
  EXPECT_FALSE(link_.loading);
  EXPECT_THAT(starts(), ElementsAre(0));
}

TEST_F(WorkerLinkTest, KeepsFirstFramesOfAVideoWhenReadingItIsCanceled) {
  hold_ = true;
  apply(state_, OpenPath{"long.mkv"});
  while (synchronize(), !state_.document.recording) std::this_thread::yield();
  state_.requests.cancel = true;
  settle();
  EXPECT_EQ(state_.frame_count(), 60);
  EXPECT_FALSE(link_.loading);
  EXPECT_EQ(state_.messages.text, "Opening canceled");
}

TEST_F(WorkerLinkTest, WaitsForTheWholeVideoIfTheWindowIsBehindItsFirstFrames) {
  state_.document.settings.start = 100;
  open_and_settle("long.mkv");
  EXPECT_EQ(state_.document.settings.start, 100);
  EXPECT_EQ(state_.frame_count(), 900);
}

TEST_F(WorkerLinkTest, ScansTheRecordingOnRequest) {
  open_and_settle("desk");
  EXPECT_EQ(state_.results.scan, nullptr);
  run("scan on");
  while (synchronize(), link_.busy()) std::this_thread::yield();
  ASSERT_NE(state_.results.scan, nullptr);
  EXPECT_EQ(state_.results.scan->of, 31);
  ASSERT_EQ(state_.results.scan->starts.size(), 31U);
  EXPECT_FALSE(state_.results.scan->starts[7].ok);
  EXPECT_FALSE(state_.results.scan->starts[7].reason.empty()) << "neither images nor tracks";
  run_once("scan off");
  EXPECT_EQ(state_.results.scan, nullptr);
}

TEST_F(WorkerLinkTest, FindsAStartAndGoesThere) {
  open_and_settle("pictures");
  run_and_settle("set start 30");
  run("find-start");
  while (synchronize(), link_.finding_start) std::this_thread::yield();
  settle();
  ASSERT_NE(state_.results.scan, nullptr);
  const ScannedStart* best = best_start(state_.results.scan->starts);
  ASSERT_NE(best, nullptr);
  EXPECT_EQ(best->readiness, Readiness::ready);
  EXPECT_TRUE(state_.messages.text.starts_with("starts at ")) << state_.messages.text;
  const Settings& settings = state_.document.settings;
  EXPECT_EQ(starts().back(), settings.start);
  EXPECT_EQ(state_.view.frame, settings.start + settings.frames - 1);
  EXPECT_NE(settings.start, 30);
  run("undo");
  EXPECT_EQ(settings.start, 30);
}

TEST(FirstReady, WaitsUntilAllEarlierStartsAreScanned) {
  const auto start = [](int frame, Readiness readiness) {
    return ScannedStart{.start = frame, .ok = true, .readiness = readiness};
  };
  using enum Readiness;
  StartScan scan{.settings = {}, .step = 6, .of = 5, .starts = {}};
  scan.starts = {start(0, weak), start(12, ready), start(24, ready)};
  EXPECT_EQ(first_ready(scan), nullptr) << "the one at 6 may be ready, too";
  scan.starts.insert(scan.starts.begin() + 1, start(6, weak));
  ASSERT_NE(first_ready(scan), nullptr);
  EXPECT_EQ(first_ready(scan)->start, 12);
  scan.starts = {start(0, weak)};
  EXPECT_EQ(first_ready(scan), nullptr);
}

TEST_F(WorkerLinkTest, EscapeClearsTheSelectionThenTheDrawerIfNothingRuns) {
  open_and_settle("desk");
  state_.selection = selected(std::vector<std::int64_t>{3});
  run("view log");
  run_once("escape");
  EXPECT_TRUE(state_.selection.tracks.empty());
  EXPECT_NE(state_.view.panes.drawer, nullptr);
  run_once("escape");
  EXPECT_EQ(state_.view.panes.drawer, nullptr);
}

TEST_F(WorkerLinkTest, EscapeCancelsAReportBeforeAnythingElse) {
  open_and_settle("a.mkv");
  state_.requests.screenshots = {{"a.html", kReportView}};
  EXPECT_FALSE(wanted_inspections(state_).empty());
  run_once("escape");
  EXPECT_FALSE(wants_report(state_));
  EXPECT_TRUE(wanted_inspections(state_).empty());
  EXPECT_EQ(state_.messages.text, "Report canceled. No file was written");
}

TEST_F(WorkerLinkTest, EscapeWhileOpeningPromisesNoComputation) {
  open_and_settle("desk");
  hold_ = true;
  apply(state_, OpenPath{"slow"});
  synchronize();
  EXPECT_TRUE(link_.loading);
  state_.requests.cancel = true;
  synchronize();
  EXPECT_EQ(state_.messages.text, "Opening canceled");
  EXPECT_FALSE(link_.loading);
  hold_ = false;
  settle();
}

TEST_F(WorkerLinkTest, EscapeWhileReadingResultsPromisesNoComputation) {
  open_and_settle("desk");
  link_.reading.busy = true;
  state_.requests.cancel = true;
  synchronize();
  EXPECT_EQ(state_.messages.text, "Opening canceled");
}

TEST_F(WorkerLinkTest, WarnsIfNoStartIsFound) {
  open_and_settle("desk");
  run("find-start");
  EXPECT_TRUE(state_.view.toggles.scan);
  while (synchronize(), link_.busy()) std::this_thread::yield();
  EXPECT_EQ(state_.document.settings.start, 0);
  EXPECT_EQ(state_.messages.severity, Severity::warning);
  EXPECT_EQ(state_.messages.text,
            "Initialization fails at every start frame. The strip above the time line shows why");
}

TEST_F(WorkerLinkTest, EscapeAndHidingTheScanStopFindingAStart) {
  open_and_settle("pictures");
  for (const auto& [frames, action] :
       {std::pair{"set frames 58", "escape"}, {"set frames 57", "scan off"}}) {
    run(frames);
    run_once("find-start");
    EXPECT_TRUE(link_.finding_start);
    run_once(action);
    EXPECT_FALSE(link_.finding_start) << action;
    settle();
  }
}

TEST_F(WorkerLinkTest, OpeningARecordingInspectsItOnce) {
  open_and_settle("desk");
  ASSERT_NE(state_.document.recording, nullptr);
  EXPECT_EQ(state_.document.recording->name, "desk");
  EXPECT_EQ(state_.view.frame, 29);
  ASSERT_NE(state_.results.inspection, nullptr);
  EXPECT_EQ(state_.results.inspection->settings, state_.document.settings);
  settle();
  EXPECT_THAT(starts(), ElementsAre(0));
}

TEST_F(WorkerLinkTest, RemembersOpenedRecordingsButNotTheExample) {
  const test::TestFolder folder;
  setenv("XDG_STATE_HOME", folder.path().c_str(), 1);
  link_.remembers_files = true;
  for (const char* name : {"good", "bad", "better"}) {
    std::filesystem::create_directories(folder.path() / name);
    open_and_settle(folder.path() / name);
  }
  run_and_settle("open-example");
  EXPECT_EQ(state_.document.recording->name, "example");
  EXPECT_THAT(recent_files(), ElementsAre(folder.path() / "better", folder.path() / "good"));
}

TEST_F(WorkerLinkTest, NamesTheMissingColumnOfResults) {
  const test::TestFolder folder;
  open_and_settle(folder.write("results.csv", "start,frames\n0,30\n"));
  EXPECT_THAT(state_.messages.text, testing::HasSubstr("no column is called recording"));
}

TEST_F(WorkerLinkTest, InspectsOnlyChangedSettings) {
  open_and_settle("desk");
  apply(state_, GoToFrame{7});
  settle();
  EXPECT_THAT(starts(), ElementsAre(0));
  run_and_settle("window-start");
  EXPECT_THAT(starts(), ElementsAre(0, 7));
  run_and_settle("compute");
  EXPECT_THAT(starts(), ElementsAre(0, 7, 7));
}

TEST_F(WorkerLinkTest, EscapeStopsTheComputationAndKeepsTheLastResult) {
  open_and_settle("desk");
  hold_ = true;
  apply(state_, GoToFrame{7});
  run_once("window-start");
  EXPECT_TRUE(link_.worker.busy);
  run_and_settle("escape");
  EXPECT_EQ(state_.results.inspection->settings.start, 0);
  EXPECT_EQ(state_.document.settings.start, 7);
  EXPECT_EQ(state_.messages.text, "Canceled. Press F5 to compute again");
}

TEST_F(WorkerLinkTest, FailedOpeningKeepsTheOldRecording) {
  open_and_settle("desk");
  open_and_settle("bad");
  EXPECT_EQ(state_.document.recording->name, "desk");
  EXPECT_EQ(link_.worker.error, "bad: no such folder");
  ASSERT_NE(state_.results.inspection, nullptr);
}

TEST_F(WorkerLinkTest, FailedStudyIsReportedOnceAndNotRetried) {
  std::atomic<int> tried = 0;
  Survey survey({}, [&](const Inspection&, const std::stop_token&) {
    ++tried;
    throw InputError("no frame has enough tracks");
    return std::shared_ptr<const NormalStudy>();
  });
  const auto turn = [&] { gpo::synchronize(state_, link_, worker_, survey, scan_); };
  apply(state_, OpenPath{"desk"});
  while (turn(), link_.busy() || !state_.results.inspection) {
  }
  run("view candidates");
  while (turn(), !state_.results.study) {
  }
  for (int i = 0; i < 5; ++i) turn();
  EXPECT_FALSE(link_.busy());
  EXPECT_EQ(tried, 1);
  const auto says_so = [](const LogLine& line) {
    return line.severity == Severity::error && line.text.ends_with("no frame has enough tracks");
  };
  EXPECT_EQ(std::ranges::count_if(state_.messages.lines, says_so), 1);
}

TEST_F(WorkerLinkTest, KeepsRequestsOfOthers) {
  state_.requests.quit = state_.requests.compute = true;
  state_.requests.screenshots.push_back({});
  synchronize();
  EXPECT_TRUE(state_.requests.quit);
  EXPECT_EQ(state_.requests.screenshots.size(), 1U);
  EXPECT_FALSE(state_.requests.compute);
}

TEST_F(WorkerLinkTest, CalibrationKeepsFrameAndBookmarks) {
  open_and_settle("bare.mp4");
  apply(state_, GoToFrame{7});
  state_.document.bookmarks = {{7, "here"}};
  run_and_settle("calibrate");
  EXPECT_EQ(state_.document.recording->camera_source, CameraSource::self_calibrated);
  EXPECT_EQ(state_.view.frame, 7);
  EXPECT_THAT(state_.document.bookmarks, ElementsAre(Bookmark{7, "here"}));
  ASSERT_NE(state_.results.inspection, nullptr);
}

TEST_F(WorkerLinkTest, CanceledCalibrationKeepsTheGuessedCamera) {
  open_and_settle("bare.mp4");
  hold_ = true;
  run_once("calibrate");
  EXPECT_TRUE(link_.worker.busy);
  state_.requests.cancel = true;
  synchronize();
  EXPECT_EQ(state_.messages.text, "Calibration canceled, nothing was saved");
  hold_ = false;
  settle();
  EXPECT_EQ(state_.document.recording->camera_source, CameraSource::guess);
}

TEST_F(WorkerLinkTest, CalibratesOpenedRecordingsWithGuessedCameraOnRequest) {
  link_.calibrates = true;
  open_and_settle("bare.mp4");
  EXPECT_EQ(state_.document.recording->camera_source, CameraSource::self_calibrated);
}

TEST_F(WorkerLinkTest, RefusesToCalibrateWithoutImages) {
  open_and_settle("desk");
  run("calibrate");
  EXPECT_FALSE(state_.requests.calibrate);
  EXPECT_THAT(state_.messages.text, testing::HasSubstr("calibrate: the recording has no images"));
}

}  // namespace
}  // namespace gpo
