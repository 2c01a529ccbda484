// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/workbench/work/worker_link.h"

#include "tests/engine/test_folder.h"
#include "ui/workbench/session/session_file.h"

#include <algorithm>
#include <cstdlib>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::WorkerLinkTest, testing::ElementsAre, testing::IsEmpty;

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

TEST_F(WorkerLinkTest, CanceledSessionLeavesTheOpenRecordingWithItsResults) {
  open_and_settle("desk");
  const auto desk = state_.document.recording;
  hold_ = true;
  state_.files.waiting_session = SavedSession{"long.mkv", std::make_shared<const WorkbenchState>()};
  apply(state_, OpenPath{"long.mkv"});
  while (synchronize(), worker_.latest().recording == desk) std::this_thread::yield();
  synchronize();
  EXPECT_EQ(state_.document.recording, desk) << "the session needs the whole video";
  EXPECT_NE(state_.results.inspection, nullptr);
  run_once("escape");
  EXPECT_FALSE(state_.files.waiting_session);
  hold_ = false;
  run_and_settle("compute");
  EXPECT_EQ(state_.document.recording, desk);
  ASSERT_NE(state_.results.inspection, nullptr);
  EXPECT_EQ(state_.results.inspection->recording, desk);
}

TEST_F(WorkerLinkTest, KeepsWhatTheUserDidWhileAVideoIsReadOn) {
  hold_ = true;
  apply(state_, OpenPath{"long.mkv"});
  while (synchronize(), !state_.document.recording) std::this_thread::yield();
  Settings settings = state_.document.settings;
  settings.exclude = {3};
  change_settings(state_, settings);
  move_cube(state_, Vector3d(0.1, 0, 1));
  state_.selection = selected(std::vector<std::int64_t>{5});
  state_.view.time_span = {10, 20};
  hold_ = false;
  settle();
  EXPECT_EQ(state_.frame_count(), 900);
  EXPECT_THAT(state_.document.settings.exclude, ElementsAre(3));
  EXPECT_TRUE(state_.document.cube_ray.has_value());
  EXPECT_THAT(state_.selection.tracks, ElementsAre(5));
  EXPECT_EQ(state_.view.time_span, (TimeSpan{10, 20}));
  EXPECT_EQ(state_.document.undo.size(), 2U);
}

TEST_F(WorkerLinkTest, MessageLineForgetsAnErrorAfterSuccess) {
  open_and_settle("desk");
  open_and_settle("bad");
  EXPECT_EQ(state_.messages.text, "bad: no such folder");
  run_and_settle("compute");
  EXPECT_EQ(state_.messages.text, "");
}

TEST_F(WorkerLinkTest, ScanSwitchedOnAfterACanceledOpeningRuns) {
  open_and_settle("desk");
  hold_ = true;
  run_once("open long.mkv");
  run_once("escape");
  EXPECT_EQ(state_.messages.text, "Opening canceled");
  hold_ = false;
  run_once("scan on");
  while (synchronize(), link_.busy()) std::this_thread::yield();
  ASSERT_NE(state_.results.scan, nullptr);
  EXPECT_TRUE(state_.results.scan->finished());
}

TEST_F(WorkerLinkTest, WaitsForTheWholeVideoIfTheWindowIsBehindItsFirstFrames) {
  state_.document.settings.start = 100;
  open_and_settle("long.mkv");
  EXPECT_EQ(state_.document.settings.start, 100);
  EXPECT_EQ(state_.frame_count(), 900);
}

TEST_F(WorkerLinkTest, OpeningARecordingCompletesTheFirstStepOfTheTour) {
  state_.view.tour = 1;
  open_and_settle("desk");
  EXPECT_EQ(state_.view.tour, 2);
  open_and_settle("long.mkv");
  EXPECT_EQ(state_.view.tour, 2) << "only the first step";
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

}  // namespace
}  // namespace gpo
