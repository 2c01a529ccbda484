// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/experiment.h"

#include "tests/engine/test_folder.h"

#include <tuple>

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
  return {.configurations = parse_configurations("gpo,gpo+no-ransac"),
          .lengths = parse_ranges(lengths, "lengths"),
          .starts = parse_ranges(starts, "starts"),
          .seed = 5};
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

TEST(Experiment, ShortRecordingHasNoLongWindows) {
  const std::vector recordings{recording("short", 12)};
  const Experiment planned = plan_experiment(recordings, request("5:20:5", "0:end:2"));
  EXPECT_THAT(planned.recordings[0].starts, ElementsAre(0, 2));  // windows of 10 frames
  EXPECT_THAT(tasks_of(planned)[1].lengths, ElementsAre(5, 10));
  EXPECT_THAT(notes_of(planned),
              ElementsAre("short: 12 frames, too short for windows of 15, 20 frames"));
  const Experiment late = plan_experiment(recordings, request("5,10", "0,6,50"));
  EXPECT_THAT(late.recordings[0].starts, ElementsAre(0, 6));
  EXPECT_THAT(tasks_of(late)[1].lengths, ElementsAre(5));
}

TEST(Experiment, RejectsEqualNamesAndWindowsThatDoNotFit) {
  const std::vector same{recording("a", 9), recording("b", 9), recording("a", 8)};
  EXPECT_THAT(error_of([&] { plan_experiment(same, request("5", "0")); }),
              HasSubstr("two recordings have the name 'a'"));
  const std::vector one{recording("a", 9)};
  EXPECT_THAT(error_of([&] { plan_experiment(one, request("10:20:5", "0")); }),
              HasSubstr("no window fits from these starts, the longest recording has 9 frames"));
  EXPECT_THAT(error_of([&] { plan_experiment(one, request("1:5", "0")); }),
              HasSubstr("lengths: a window has at least 2 frames"));
}

TEST(Experiment, SurvivesJson) {
  const std::vector recordings{recording("a", 90), recording("b", 65)};
  const Experiment planned = plan_experiment(recordings, request("5:60:5", "0:end:10"));
  EXPECT_EQ(experiment_from_json(to_json(planned)), planned);
}

std::vector<std::string> plan_differences(const Experiment& a, const Experiment& b) {
  EXPECT_TRUE(differences(a, b).content.empty());
  return differences(a, b).plan;
}

TEST(Experiment, IgnoresThePathsOfRecordings) {
  const Experiment here =
      plan_experiment(std::vector{recording("a", 90)}, request("5:60:5", "0:end:10"));
  Experiment there = here;
  there.recordings[0].path = "/another/machine/a/";
  EXPECT_TRUE(plan_differences(here, there).empty());
}

TEST(Experiment, NamesDifferences) {
  const std::vector recordings{recording("a", 90), recording("b", 70)};
  const auto planned = [&](const char* lengths, const char* starts) {
    return plan_experiment(recordings, request(lengths, starts));
  };
  const Experiment base = planned("5:60:5", "0:end:10");
  // Other lengths imply another last start.
  EXPECT_THAT(plan_differences(base, planned("5:50:5", "0:end:10")), ElementsAre("lengths"));
  EXPECT_THAT(plan_differences(base, planned("5:60:5", "0:end:5")), ElementsAre("starts"));
  Experiment other = base;
  other.configurations.pop_back();
  other.seed = 6;
  EXPECT_THAT(plan_differences(base, other), ElementsAre("methods", "seed"));
  EXPECT_EQ(differ_text({"methods", "seed"}), "`methods`, `seed` differ");
  other = base;
  other.recordings.pop_back();
  EXPECT_THAT(plan_differences(base, other), ElementsAre("recordings"));
  other = base;
  other.recordings[1].content["fx"] = "601";
  other.recordings[1].starts = {0};  // may follow from the content
  other.program = "0.0.9";
  EXPECT_TRUE(differences(base, other).plan.empty());
  EXPECT_THAT(differences(base, other).content, ElementsAre("version of the program", "fx of b"));
}

TEST(Experiment, TimesWindowsOfThirtyFramesOrTheNextShorterLength) {
  EXPECT_EQ(timed_length({10, 30, 60}), 30);
  EXPECT_EQ(timed_length({10, 20, 60}), 20);
  EXPECT_EQ(timed_length({40, 60}), 40);
}

std::vector<int> numbers(const std::string& text, int end = 47) {
  return numbers_in(parse_ranges(text, "starts"), end);
}

TEST(Ranges, IncludeBothEnds) {
  EXPECT_THAT(numbers("5:20:5"), ElementsAre(5, 10, 15, 20));
  EXPECT_THAT(numbers("5:19:5"), ElementsAre(5, 10, 15));
  EXPECT_THAT(numbers("3:5"), ElementsAre(3, 4, 5));
  EXPECT_THAT(numbers("7"), ElementsAre(7));
  EXPECT_THAT(numbers("30,10:20:10,20"), ElementsAre(10, 20, 30));
}

TEST(Ranges, EndDependsOnTheRecording) {
  EXPECT_THAT(numbers("0:end:20"), ElementsAre(0, 20, 40));
  EXPECT_THAT(numbers("0:end:20", 40), ElementsAre(0, 20, 40));
  EXPECT_THAT(numbers("5:end:5", 4), ElementsAre());
}

TEST(Ranges, RejectInvalidTextWithTheOption) {
  for (const char* text : {"a",
                           "5:x:5",
                           "5:60:0",
                           "5:60:-5",
                           "60:5:5",
                           "1:2:3:4",
                           "5:",
                           "-1:3",
                           "1.5",
                           "5,,6",
                           "end",
                           "1:9999999"}) {
    const std::string error = error_of([&] { parse_ranges(text, "lengths"); });
    EXPECT_THAT(error, HasSubstr(std::string("lengths: '") + text + "'")) << text;
  }
  EXPECT_THAT(error_of([] { parse_ranges("", "lengths"); }), HasSubstr("lengths"));
}

TEST(Shards, DifferByAtMostOneWindow) {
  const std::vector recordings{recording("a", 60)};
  const Experiment one_start = plan_experiment(recordings, request("5:60:5", "0"));
  for (const int count : {1, 5, 8, 12, 20}) {
    std::vector<int> lengths;
    for (int k = 1; k <= count; ++k) {
      const auto tasks = tasks_of(one_start, {k, count});
      const int even = 12 / count;
      EXPECT_GE(window_count(tasks), even) << k << "/" << count;
      EXPECT_LE(window_count(tasks), even + 1) << k << "/" << count;
      for (const ExperimentTask& task : tasks)
        lengths.insert(lengths.end(), task.lengths.begin(), task.lengths.end());
    }
    EXPECT_EQ(lengths, one_start.lengths) << count;
  }
  EXPECT_THAT(tasks_of(one_start, {2, 8})[0].lengths, ElementsAre(15, 20));
}

TEST(Shards, KeepWindowsOfAStartTogether) {
  const std::vector recordings{recording("a", 90)};
  const Experiment planned = plan_experiment(recordings, request("5:60:5", "0:end:10"));
  for (int k = 1; k <= 4; ++k) {
    const auto tasks = tasks_of(planned, {k, 4});
    ASSERT_EQ(tasks.size(), 1U);
    EXPECT_EQ(tasks[0].start, 10 * (k - 1));
    EXPECT_EQ(tasks[0].lengths.size(), 12U);
  }
}

TEST(Shards, AreDisjointAndComplete) {
  const std::vector recordings{recording("a", 90), recording("b", 85)};
  const Experiment planned = plan_experiment(recordings, request("5:60:5", "0:end:10"));
  using Window = std::tuple<std::size_t, int, int>;
  const auto add = [](std::vector<Window>& to, const std::vector<ExperimentTask>& tasks) {
    for (const ExperimentTask& task : tasks)
      for (const int frames : task.lengths) to.emplace_back(task.recording, task.start, frames);
  };
  std::vector<Window> seen, all;
  for (int k = 1; k <= 7; ++k) add(seen, tasks_of(planned, {k, 7}));
  add(all, tasks_of(planned));
  EXPECT_EQ(seen, all);
}

TEST(Shards, AreParsedFromKOfN) {
  EXPECT_EQ(parse_shard("2/8").index, 2);
  EXPECT_EQ(parse_shard("2/8").count, 8);
  for (const char* text : {"",
                           "2",
                           "2/",
                           "/8",
                           "0/8",
                           "9/8",
                           "2/8x",
                           "-1/8",
                           "a/b",
                           "2/99999999999",
                           "4294967297/4294967298"}) {
    EXPECT_THAT(error_of([&] { parse_shard(text); }), HasSubstr("shard: '")) << text;
  }
}

}  // namespace
}  // namespace gpo
