// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/experiment.h"

#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::shared_ptr<const Recording> recording(const std::string& name, int frames) {
  Recording made;
  made.path = "somewhere/" + name;
  made.name = name;
  made.timestamps_ns.resize(frames);
  return std::make_shared<const Recording>(made);
}

ExperimentRequest request(const std::string& lengths, const std::string& starts) {
  return {parse_configurations("gpo,gpo+no-ransac"),
          parse_ranges(lengths, "--lengths"),
          parse_ranges(starts, "--starts"),
          5};
}

TEST(Experiment, AllLengthsShareTheStarts) {
  const std::vector recordings{recording("a", 90), recording("b", 65)};
  const Experiment planned = plan_experiment(recordings, request("5:60:5", "0:end:10"));
  EXPECT_THAT(planned.recordings[0].starts, ElementsAre(0, 10, 20, 30));
  EXPECT_THAT(planned.recordings[1].starts, ElementsAre(0));
  const auto tasks = tasks_of(planned);
  EXPECT_EQ(tasks.size(), 5U);
  EXPECT_EQ(tasks[4].recording, 1U);
  EXPECT_EQ(window_count(tasks), 60);
  EXPECT_TRUE(notes_of(planned).empty());
}

TEST(Experiment, AShortRecordingLacksTheLongWindows) {
  const std::vector recordings{recording("short", 12)};
  const Experiment planned = plan_experiment(recordings, request("5:20:5", "0:end:2"));
  EXPECT_THAT(planned.recordings[0].starts, ElementsAre(0, 2));  // of 10 frames
  EXPECT_THAT(tasks_of(planned)[1].lengths, ElementsAre(5, 10));
  EXPECT_THAT(notes_of(planned),
              ElementsAre("short: 12 frames, too short for windows of 15, 20 frames"));
  const Experiment late = plan_experiment(recordings, request("5,10", "0,6,50"));
  EXPECT_THAT(late.recordings[0].starts, ElementsAre(0, 6));
  EXPECT_THAT(tasks_of(late)[1].lengths, ElementsAre(5));
}

TEST(Experiment, RefusesWhatCannotBePlanned) {
  const std::vector same{recording("a", 9), recording("b", 9), recording("a", 8)};
  EXPECT_THAT(error_of([&] { plan_experiment(same, request("5", "0")); }),
              HasSubstr("two recordings have the name 'a'"));
  const std::vector one{recording("a", 9)};
  EXPECT_THAT(error_of([&] { plan_experiment(one, request("10:20:5", "0")); }),
              HasSubstr("no window fits, the longest recording has 9 frames"));
  EXPECT_THAT(error_of([&] { plan_experiment(one, request("1:5", "0")); }),
              HasSubstr("--lengths: a window has at least 2 frames"));
}

TEST(Experiment, ComesBackFromJson) {
  const std::vector recordings{recording("a", 90), recording("b", 65)};
  const Experiment planned = plan_experiment(recordings, request("5:60:5", "0:end:10"));
  EXPECT_EQ(experiment_from_json(to_json(planned)), planned);
}

TEST(Shards, AreDisjointAndTogetherAll) {
  const std::vector recordings{recording("a", 90), recording("b", 85)};
  const Experiment planned = plan_experiment(recordings, request("5:60:5", "0:end:10"));
  std::vector<std::pair<std::size_t, int>> seen;
  for (int k = 1; k <= 3; ++k) {
    for (const ExperimentTask& task : tasks_of(planned, {k, 3})) {
      seen.emplace_back(task.recording, task.start);
    }
  }
  std::ranges::sort(seen);
  std::vector<std::pair<std::size_t, int>> all;
  for (const ExperimentTask& task : tasks_of(planned)) all.emplace_back(task.recording, task.start);
  EXPECT_EQ(seen, all);
}

TEST(Shards, AreWrittenKOfN) {
  EXPECT_EQ(parse_shard("2/8").index, 2);
  EXPECT_EQ(parse_shard("2/8").count, 8);
  for (const char* text : {"", "2", "0/8", "9/8", "2/8x", "-1/8", "a/b"}) {
    EXPECT_THAT(error_of([&] { parse_shard(text); }), HasSubstr("--shard: '")) << text;
  }
}

}  // namespace
}  // namespace gpo
