// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/runner.h"

#include "engine/experiment/window_files.h"
#include "engine/inspection/inspection.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/engine/experiment/made_rows.h"
#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using test::csv_without_times;
using test::error_of;
using test::TestFolder;
using ::testing::HasSubstr;

/// Six windows of the bundled recording, which run by themselves in a second.
class RunnerTest : public ::testing::Test {
 protected:
  RunnerTest() : experiment_(plan("5,7")) {}

  Experiment plan(const std::string& lengths) const {
    return plan_experiment(recordings_,
                           {parse_configurations("gpo,gpo+no-ransac,gpo+averaging"),
                            parse_ranges(lengths, "--lengths"),
                            parse_ranges("0:20:10", "--starts"),
                            3});
  }
  bool run(const fs::path& folder, const RunOptions& options = {}) const {
    return run_experiment(experiment_, recordings_, folder, options);
  }
  /// Stops after so many windows.
  void interrupt(const fs::path& folder, int windows) const {
    std::stop_source source;
    RunOptions options;
    options.stop = source.get_token();
    options.progress = [&](const ExperimentProgress& progress) {
      if (progress.done == windows) source.request_stop();
    };
    EXPECT_FALSE(run(folder, options));
  }
  std::vector<Row> rows(const fs::path& folder) const {
    return collect_rows(experiment_, std::span(&folder, 1));
  }
  static int windows_in(const fs::path& folder) {
    return static_cast<int>(std::distance(fs::directory_iterator(folder / "windows"), {}));
  }

  const TestFolder folder_;
  const fs::path a_ = folder_.path() / "a";
  const fs::path b_ = folder_.path() / "b";
  const std::vector<std::shared_ptr<const Recording>> recordings_{
      open_recording(std::string(GPO_SOURCE_DIR) + "/sequences/desk")};
  const Experiment experiment_;
};

TEST_F(RunnerTest, RowsAreWhatRunGivesInTheOrderOfThePlan) {
  ASSERT_TRUE(run(a_));
  std::vector<Row> expected;
  for (const int start : {0, 10, 20}) {
    for (const int frames : {5, 7}) {
      for (const Configuration& c : experiment_.configurations) {
        const Settings window{.start = start, .frames = frames, .seed = 3};
        expected.push_back(make_row(*Inspector(recordings_[0]).inspect(apply(c, window))));
      }
    }
  }
  EXPECT_EQ(csv_without_times(rows(a_)), csv_without_times(expected));
}

TEST_F(RunnerTest, JobsDoNotMatter) {
  ASSERT_TRUE(run(a_, {.jobs = 1}));
  ASSERT_TRUE(run(b_, {.jobs = 3}));
  EXPECT_EQ(csv_without_times(rows(a_)), csv_without_times(rows(b_)));
}

TEST_F(RunnerTest, FinishedWindowsAreNotDoneAgain) {
  interrupt(a_, 2);
  EXPECT_EQ(windows_in(a_), 2);
  for (const auto& file : fs::directory_iterator(a_ / "windows")) {
    const std::string name = "a/windows/" + file.path().filename().string();
    auto window = nlohmann::ordered_json::parse(folder_.read(name));
    for (auto& row : window) row["track_ms"] = 12345.0;
    folder_.write(name, window.dump());
  }
  int first_done = -1;
  RunOptions options;
  options.progress = [&](const ExperimentProgress& progress) {
    if (first_done < 0) first_done = progress.done;
  };
  ASSERT_TRUE(run(a_, options));
  EXPECT_EQ(first_done, 2);
  const std::vector<Row> resumed = rows(a_);
  EXPECT_EQ(std::ranges::count(resumed, 12345.0, [](const Row& r) { return *r.track_ms; }), 6);
  ASSERT_TRUE(run(b_));
  EXPECT_EQ(csv_without_times(resumed), csv_without_times(rows(b_)));
}

TEST_F(RunnerTest, TornAndForeignFilesAreDoneAgain) {
  ASSERT_TRUE(run(a_));
  const std::string expected = csv_without_times(rows(a_));
  folder_.cut("a/windows/desk-10-5.json", 0.5);
  folder_.write("a/windows/desk-20-7.json", std::string("[]"));
  folder_.write("a/windows/desk-0-5.json.0a0b0c0d.partial", std::string("["));
  EXPECT_THAT(error_of([&] { rows(a_); }),
              HasSubstr("2 of 6 windows are missing (desk from frame 10, desk from frame 20)"));
  ASSERT_TRUE(run(a_));
  EXPECT_EQ(csv_without_times(rows(a_)), expected);
}

TEST_F(RunnerTest, AnotherExperimentIsRefused) {
  interrupt(a_, 1);
  EXPECT_THAT(
      error_of([&] { run_experiment(plan("5,8"), recordings_, a_, {}); }),
      HasSubstr(
          "experiment.json: is of another experiment (`lengths` differs), expected the same"));
  EXPECT_EQ(windows_in(a_), 1);
  folder_.write("a/experiment.json", std::string("{\"format\": 0}"));
  EXPECT_THAT(error_of([&] { run(a_); }), HasSubstr("experiment.json: key `format`"));
  folder_.write("a/experiment.json", std::string("{"));
  EXPECT_THAT(error_of([&] { run(a_); }), HasSubstr("is not the definition of an experiment"));
}

TEST_F(RunnerTest, ShardsMergeToWhatOneRunMakes) {
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
  EXPECT_EQ(csv_without_times(rows(d)), csv_without_times(rows(a_)));
  EXPECT_EQ(folder_.read("d/experiment.json"), folder_.read("a/experiment.json"));
  EXPECT_EQ(folder_.read("d/windows/desk-10-5.json"), folder_.read("c/windows/desk-10-5.json"));
}

TEST_F(RunnerTest, MergeNamesWhatIsMissingAndRefusesDifferentExperiments) {
  ASSERT_TRUE(run(a_, {.shard = {2, 3}}));
  const fs::path merged = folder_.path() / "merged";
  EXPECT_THAT(error_of([&] { merge_experiments(std::span(&a_, 1), merged); }),
              HasSubstr("4 of 6 windows are missing (desk from frame 0, desk from frame 20)"));
  EXPECT_FALSE(fs::exists(merged));
  begin_experiment(b_, plan("5,8"));
  const std::vector folders{a_, b_};
  EXPECT_THAT(error_of([&] { merge_experiments(folders, merged); }),
              HasSubstr("different experiments (`lengths` differs)"));
  const std::vector nowhere{folder_.path() / "nowhere"};
  EXPECT_THAT(error_of([&] { merge_experiments(nowhere, merged); }), HasSubstr("nowhere"));
}

TEST_F(RunnerTest, WhatARecordingLacksIsAFailedRowWithTheReason) {
  Recording bare = *recordings_[0];
  bare.gyroscope.reset();
  const std::vector recordings{std::make_shared<const Recording>(bare)};
  const Experiment experiment = plan_experiment(
      recordings, {parse_configurations("gpo+gyro,gpo"), {{5, 5, 1}}, {{0, 0, 1}}, 1});
  ASSERT_TRUE(run_experiment(experiment, recordings, a_, {}));
  const std::vector<Row> rows = collect_rows(experiment, std::span(&a_, 1));
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].status, "failed");
  EXPECT_EQ(rows[0].reason, "rotations: gyro: desk has no gyroscope");
  EXPECT_FALSE(rows[0].pne_deg);
  EXPECT_EQ(rows[1].settings.rotations, RotationSource::averaging);
}

}  // namespace
}  // namespace gpo
