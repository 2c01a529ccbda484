// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/runner.h"

#include "engine/external_methods/own_method.h"
#include "engine/inspection/inspector.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/engine/experiment/made_rows.h"
#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Six windows of the bundled recording, which run by themselves in a second.
class RunnerTest : public ::testing::Test {
 protected:
  using Recordings = std::vector<std::shared_ptr<const Recording>>;

  static Experiment plan(const Recordings& recordings, const std::string& lengths = "5,7") {
    return plan_experiment(
        recordings,
        {.configurations = parse_configurations("gpo,gpo+no-ransac,gpo+averaging"),
         .lengths = parse_ranges(lengths, "lengths"),
         .starts = parse_ranges("0:20:10", "starts"),
         .seed = 3});
  }
  Recordings with_focal_length(double fx) const {
    Recording other = *recordings_[0];
    other.camera.fx = fx;
    return {std::make_shared<const Recording>(other)};
  }
  bool run(const fs::path& folder, const RunOptions& options = {}) const {
    return run_experiment(experiment_, recordings_, folder, options);
  }
  /// Stops after a number of windows.
  void interrupt(const fs::path& folder, int windows) const {
    std::stop_source source;
    RunOptions options;
    options.stop = source.get_token();
    options.progress = [&](const ExperimentProgress& progress) {
      if (progress.done == windows) source.request_stop();
    };
    EXPECT_FALSE(run(folder, options));
  }
  /// Runs an experiment. Returns the number of windows that were done before.
  int resume(const Experiment& experiment, const Recordings& recordings, RunOptions options) const {
    int first_done = -1;
    options.progress = [&](const ExperimentProgress& progress) {
      if (first_done < 0) first_done = progress.done;
    };
    EXPECT_TRUE(run_experiment(experiment, recordings, a_, options));
    return first_done;
  }
  std::vector<Row> rows(const fs::path& folder) const {
    return collect_rows(experiment_, std::span(&folder, 1));
  }
  std::string csv(const fs::path& folder) const { return csv_without_times(rows(folder)); }
  void edit(const std::string& name, const std::function<void(nlohmann::ordered_json&)>& change) {
    auto window = nlohmann::ordered_json::parse(folder_.read(name));
    change(window);
    folder_.write(name, window.dump());
  }
  static int windows_in(const fs::path& folder) {
    return static_cast<int>(std::distance(fs::directory_iterator(folder / "windows"), {}));
  }

  const TestFolder folder_;
  const fs::path a_ = folder_.path() / "a";
  const fs::path b_ = folder_.path() / "b";
  const Recordings recordings_{open_recording(std::string(GPO_SOURCE_DIR) + "/sequences/desk")};
  const Experiment experiment_ = plan(recordings_);
};

TEST_F(RunnerTest, RowsEqualSingleRunsInTheOrderOfThePlan) {
  ASSERT_TRUE(run(a_));
  std::vector<Row> expected;
  for (const int start : {0, 10, 20})
    for (const int frames : {5, 7})
      for (const Configuration& c : experiment_.configurations) {
        const Settings window{.start = start, .frames = frames, .options = {.seed = 3}};
        expected.push_back(make_row(*Inspector(recordings_[0]).inspect(apply(c, window))));
      }
  EXPECT_EQ(csv(a_), csv_without_times(expected));
}

TEST_F(RunnerTest, ResultsDoNotDependOnJobsAndImagesAreFreed) {
  ASSERT_TRUE(run(a_, {.jobs = 1}));
  ASSERT_TRUE(run(b_, {.jobs = 3}));
  EXPECT_EQ(recordings_[0]->images->bytes(), 0U);
  EXPECT_EQ(csv(a_), csv(b_));
}

TEST_F(RunnerTest, FinishedWindowsAreNotRecomputedUnderAnotherPath) {
  interrupt(a_, 2);
  EXPECT_EQ(windows_in(a_), 2);
  for (const auto& file : fs::directory_iterator(a_ / "windows"))
    edit("a/windows/" + file.path().filename().string(), [](auto& window) {
      for (auto& row : window["rows"]) row["track_ms"] = 12345.0;
    });
  Experiment moved = experiment_;
  moved.recordings[0].path = "/another/machine/./desk/";
  EXPECT_EQ(resume(moved, recordings_, {}), 2);
  const std::vector<Row> resumed = rows(a_);
  EXPECT_EQ(std::ranges::count(resumed, 12345.0, [](const Row& r) { return *r.track_ms; }), 6);
  ASSERT_TRUE(run(b_));
  EXPECT_EQ(csv_without_times(resumed), csv(b_));
}

TEST_F(RunnerTest, TruncatedAndForeignFilesAreRecomputed) {
  ASSERT_TRUE(run(a_));
  const std::string expected = csv(a_);
  folder_.cut("a/windows/desk-10-5.json", 0.5);
  folder_.write("a/windows/desk-20-7.json", std::string("[]"));
  folder_.write("a/windows/desk-0-5.json.0a0b0c0d.partial", std::string("["));
  EXPECT_THAT(error_of([&] { rows(a_); }),
              HasSubstr("2 of 6 windows are missing (desk from frame 10, desk from frame 20)"));
  ASSERT_TRUE(run(a_));
  EXPECT_EQ(csv(a_), expected);
}

TEST_F(RunnerTest, RejectsAnotherExperiment) {
  interrupt(a_, 1);
  const auto error = [&](const Experiment& other) {
    return error_of([&] { run_experiment(other, recordings_, a_, {}); });
  };
  EXPECT_THAT(
      error(plan(recordings_, "5,8")),
      HasSubstr(
          "experiment.json: belongs to another experiment (`lengths` differs); choose another"));
  EXPECT_THAT(error(plan(recordings_, "5")), HasSubstr("or add to its methods, lengths"));
  Experiment other = experiment_;
  other.configurations.pop_back();
  EXPECT_THAT(error(other), HasSubstr("(`methods` differs)"));
  EXPECT_EQ(windows_in(a_), 1);
  folder_.write("a/experiment.json", std::string("{\"format\": 0}"));
  EXPECT_THAT(error(experiment_), HasSubstr("experiment.json: key `format`"));
  folder_.write("a/experiment.json", std::string("{"));
  EXPECT_THAT(error(experiment_), HasSubstr("is not the definition of an experiment"));
}

TEST_F(RunnerTest, WindowsOfAnotherCalibrationAreRecomputed) {
  ASSERT_TRUE(run(a_));
  const Recordings changed = with_focal_length(600);
  const Experiment other = plan(changed);
  std::vector<std::string> notes;
  RunOptions options;
  options.note = [&](const std::string& note) { notes.push_back(note); };
  EXPECT_EQ(resume(other, changed, options), 0);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0], HasSubstr("`fx of desk` differs from the earlier run; the affected"));
  ASSERT_TRUE(run_experiment(other, changed, b_, {}));
  EXPECT_EQ(csv_without_times(collect_rows(other, std::span(&a_, 1))),
            csv_without_times(collect_rows(other, std::span(&b_, 1))));
  EXPECT_EQ(read_experiment(a_), other);
}

TEST_F(RunnerTest, MergeRejectsWindowsOfAnotherCalibrationOrProgram) {
  const Recordings changed = with_focal_length(600);
  ASSERT_TRUE(run(a_, {.shard = {1, 2}}));
  ASSERT_TRUE(run_experiment(plan(changed), changed, b_, {.shard = {2, 2}}));
  const fs::path merged = folder_.path() / "merged";
  const std::vector folders{a_, b_};
  EXPECT_THAT(error_of([&] { merge_experiments(folders, merged); }),
              HasSubstr("different experiments (`fx of desk` differs)"));
  // Two shards in one folder: the second one replaces the definition.
  ASSERT_TRUE(run_experiment(plan(changed), changed, a_, {.shard = {2, 2}}));
  EXPECT_THAT(error_of([&] { merge_experiments(std::span(&a_, 1), merged); }),
              HasSubstr("desk-0-5.json: belongs to another experiment than experiment.json (`fx of "
                        "desk` differs)"));
  EXPECT_FALSE(fs::exists(merged));
  edit("b/windows/desk-20-7.json", [](auto& window) { window["program"] = "0.0.1"; });
  const ExperimentTask task{0, 20, {7}};
  EXPECT_EQ(load_window(b_, plan(changed), task, 7).differs,
            std::vector<std::string>{"build of the program"});
}

TEST_F(RunnerTest, RejectsFoldersWithOtherFiles) {
  folder_.write("a/mine.txt", std::string("keep"));
  EXPECT_THAT(error_of([&] { run(a_); }),
              HasSubstr("is not empty; choose a new or empty folder, or one with experiment.json"));
  EXPECT_FALSE(fs::exists(a_ / "experiment.json"));
}

TEST_F(RunnerTest, AddingAMethodLengthOrStartComputesOnlyThese) {
  const auto extend =
      [&](const std::string& methods, const std::string& lengths, const std::string& starts) {
        const Experiment wanted = plan_experiment(recordings_,
                                                  {.configurations = parse_configurations(methods),
                                                   .lengths = parse_ranges(lengths, "lengths"),
                                                   .starts = parse_ranges(starts, "starts"),
                                                   .seed = 3});
        ExperimentProgress last;
        RunOptions options;
        options.progress = [&](const ExperimentProgress& progress) { last = progress; };
        EXPECT_TRUE(run_experiment(wanted, recordings_, a_, options));
        EXPECT_EQ(read_experiment(a_), wanted);
        return std::pair(last.kept, last.computed);
      };
  EXPECT_EQ(extend("gpo", "5", "0,10"), std::pair(0, 2));
  EXPECT_EQ(extend("gpo", "5", "0,10"), std::pair(2, 0));
  EXPECT_EQ(extend("gpo+averaging,gpo", "5", "0,10"), std::pair(2, 2));
  EXPECT_EQ(extend("gpo+averaging,gpo", "5,7", "0,10"), std::pair(4, 4));
  EXPECT_EQ(extend("gpo,gpo+no-ransac,gpo+averaging", "5,7", "0,10,20"), std::pair(8, 10));
  const std::string extended = csv(a_);
  ASSERT_TRUE(run(b_));
  EXPECT_EQ(extended, csv(b_));
}

TEST_F(RunnerTest, AddingARecordingKeepsTheOthers) {
  ASSERT_TRUE(run(a_));
  Recording other = *recordings_[0];
  other.name = "other";
  const Recordings both{recordings_[0], std::make_shared<const Recording>(other)};
  ExperimentProgress last;
  RunOptions options;
  options.progress = [&](const ExperimentProgress& progress) { last = progress; };
  ASSERT_TRUE(run_experiment(plan(both), both, a_, options));
  EXPECT_EQ(last.kept, 18);
  EXPECT_EQ(last.computed, 18);
}

/// A user's method that fails at once; `identity` stands for its command or files.
MethodTable with_own(const std::string& identity) {
  MethodTable methods;
  const auto fail = [](const Window&, const Sources&, const Watch&) { return failed("mine: no"); };
  methods.add(own_method("mine", 0, fail, identity));
  return methods;
}

TEST_F(RunnerTest, ChangedFilesOfAMethodLeaveTheOtherMethods) {
  const auto computed = [&](const std::string& identity) {
    const Experiment wanted =
        plan_experiment(recordings_,
                        {.configurations = parse_configurations("gpo,mine", with_own(identity)),
                         .lengths = {{5, 5}},
                         .starts = parse_ranges("0,10", "starts")});
    ExperimentProgress last;
    RunOptions options;
    options.progress = [&](const ExperimentProgress& progress) { last = progress; };
    EXPECT_TRUE(run_experiment(wanted, recordings_, a_, options));
    return last.computed;
  };
  EXPECT_EQ(computed("first"), 4);
  EXPECT_EQ(computed("first"), 0);
  EXPECT_EQ(computed("second"), 2);
}

TEST_F(RunnerTest, TimedWindowsComeLastAndRecordTheirJobs) {
  std::vector<std::string> timed_too_early;  // 7 frames are nearest to 30
  RunOptions options{.jobs = 2, .timing_jobs = 1};
  options.progress = [&](const ExperimentProgress& progress) {
    if (progress.done > 3 || !fs::exists(a_ / "windows")) return;
    for (const auto& file : fs::directory_iterator(a_ / "windows"))
      if (file.path().stem().string().ends_with("-7"))
        timed_too_early.push_back(file.path().filename());
  };
  ASSERT_TRUE(run(a_, options));
  EXPECT_TRUE(timed_too_early.empty());
  for (const Row& row : rows(a_)) {
    EXPECT_EQ(row.jobs, row.settings.frames == 7 ? 1 : 2);
    EXPECT_FALSE(row.processor.empty());
  }
}

TEST_F(RunnerTest, MergedShardsEqualASingleRun) {
  ASSERT_TRUE(run(a_));
  const fs::path c = folder_.path() / "c";
  const fs::path d = folder_.path() / "d";
  ASSERT_TRUE(run(b_, {.shard = {1, 3}}));
  ASSERT_TRUE(run(c, {.shard = {2, 3}}));
  ASSERT_TRUE(run(c, {.shard = {3, 3}}));  // two of them share a folder
  EXPECT_EQ(windows_in(b_), 2);
  EXPECT_EQ(windows_in(c), 4);
  const std::vector folders{b_, c};
  EXPECT_EQ(merge_experiments(folders, d), experiment_);
  EXPECT_EQ(csv(d), csv(a_));
  EXPECT_EQ(folder_.read("d/experiment.json"), folder_.read("a/experiment.json"));
  EXPECT_EQ(folder_.read("d/windows/desk-10-5.json"), folder_.read("c/windows/desk-10-5.json"));
}

TEST_F(RunnerTest, MergeNamesMissingWindowsAndRejectsDifferentExperiments) {
  ASSERT_TRUE(run(a_, {.shard = {2, 3}}));
  const fs::path merged = folder_.path() / "merged";
  EXPECT_THAT(error_of([&] { merge_experiments(std::span(&a_, 1), merged); }),
              HasSubstr("4 of 6 windows are missing (desk from frame 0, desk from frame 20)"));
  EXPECT_FALSE(fs::exists(merged));
  begin_experiment(b_, plan(recordings_, "5,8"));
  const std::vector folders{a_, b_};
  EXPECT_THAT(error_of([&] { merge_experiments(folders, merged); }),
              HasSubstr("different experiments (`lengths` differs)"));
  const std::vector nowhere{folder_.path() / "nowhere"};
  EXPECT_THAT(error_of([&] { merge_experiments(nowhere, merged); }), HasSubstr("nowhere"));
}

TEST_F(RunnerTest, MissingSensorGivesAFailedRowWithTheReason) {
  Recording bare = *recordings_[0];
  bare.gyroscope.reset();
  const std::vector recordings{std::make_shared<const Recording>(bare)};
  const Experiment experiment =
      plan_experiment(recordings,
                      {.configurations = parse_configurations("gpo+gyro,gpo"),
                       .lengths = {{5, 5}},
                       .starts = {{0, 0}}});
  ASSERT_TRUE(run_experiment(experiment, recordings, a_, {}));
  const std::vector<Row> rows = collect_rows(experiment, std::span(&a_, 1));
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].status, "failed");
  EXPECT_EQ(rows[0].reason, "rotations: gyro: desk has no gyroscope");
  EXPECT_FALSE(rows[0].pne_deg);
  EXPECT_EQ(rows[1].settings.options.rotations, RotationSource::averaging);
}

}  // namespace
}  // namespace gpo::test
