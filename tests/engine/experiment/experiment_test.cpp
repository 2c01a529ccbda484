// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/experiment.h"

#include "engine/files/text_file.h"
#include "engine/methods/methods.h"
#include "tests/engine/test_folder.h"

#include <set>
#include <tuple>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::ElementsAre, testing::HasSubstr;

std::shared_ptr<const Recording> recording(const std::string& name, int frames) {
  Recording made;
  made.path = "somewhere/" + name;
  made.name = name;
  made.timestamps_ns.resize(frames);
  return std::make_shared<const Recording>(made);
}

using Recordings = std::vector<std::shared_ptr<const Recording>>;

/// Plans windows of 5, 10, ... 60 frames from every tenth frame, or others.
Experiment planned(const Recordings& recordings,
                   const std::string& lengths = "5:60:5",
                   const std::string& starts = "0:end:10") {
  return plan_experiment(recordings,
                         {.configurations = parse_configurations("gpo,gpo+no-ransac"),
                          .lengths = parse_ranges(lengths, "lengths"),
                          .starts = parse_ranges(starts, "starts"),
                          .seed = 5});
}

TEST(Experiment, HasLengthsThatShareTheStartsAndSurvivesJson) {
  const Experiment experiment = planned({recording("a", 90), recording("b", 65)});
  EXPECT_THAT(experiment.recordings[0].starts, ElementsAre(0, 10, 20, 30));
  EXPECT_THAT(experiment.recordings[1].starts, ElementsAre(0));
  const auto tasks = tasks_of(experiment);
  EXPECT_EQ(tasks.size(), 5U);
  EXPECT_EQ(tasks[4].recording, 1U);
  EXPECT_EQ(window_count(tasks), 60);
  EXPECT_TRUE(notes_of(experiment).empty());
  EXPECT_EQ(experiment_from_json(to_json(experiment)), experiment);
}

TEST(Experiment, ShortRecordingHasNoLongWindows) {
  const Recordings recordings{recording("short", 12)};
  const Experiment experiment = planned(recordings, "5:20:5", "0:end:2");
  EXPECT_THAT(experiment.recordings[0].starts, ElementsAre(0, 2));  // windows of 10 frames
  EXPECT_THAT(tasks_of(experiment)[1].lengths, ElementsAre(5, 10));
  EXPECT_THAT(notes_of(experiment),
              ElementsAre("short: 12 frames, too short for windows of 15, 20 frames"));
  const Experiment late = planned(recordings, "5,10", "0,6,50");
  EXPECT_THAT(late.recordings[0].starts, ElementsAre(0, 6));
  EXPECT_THAT(tasks_of(late)[1].lengths, ElementsAre(5));
}

TEST(Experiment, RejectsEqualNamesAndWindowsThatDoNotFit) {
  const auto error = [](const Recordings& recordings, const char* lengths) {
    return error_of([&] { planned(recordings, lengths, "0"); });
  };
  const auto one = recording("a", 9);
  EXPECT_THAT(error({one, recording("b", 9), recording("a", 8)}, "5"),
              HasSubstr("two recordings have the name 'a'"));
  EXPECT_THAT(error({one}, "10:20:5"),
              HasSubstr("no window fits from these starts, the longest recording has 9 frames"));
  EXPECT_THAT(error({one}, "1:5"), HasSubstr("lengths: a window has at least 2 frames"));
}

std::vector<std::string> plan_differences(const Experiment& a, const Experiment& b) {
  EXPECT_TRUE(differences(a, b).content.empty());
  return differences(a, b).plan;
}

TEST(Experiment, NamesDifferencesExceptForPaths) {
  const Recordings recordings{recording("a", 90), recording("b", 70)};
  const Experiment base = planned(recordings);
  Experiment other = base;
  other.recordings[0].path = "/another/machine/a/";
  EXPECT_TRUE(plan_differences(base, other).empty());
  // Other lengths imply another last start.
  EXPECT_THAT(plan_differences(base, planned(recordings, "5:50:5")), ElementsAre("lengths"));
  EXPECT_THAT(plan_differences(base, planned(recordings, "5:60:5", "0:end:5")),
              ElementsAre("starts"));
  other = base;
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
  EXPECT_THAT(differences(base, other).content, ElementsAre("build of the program", "fx of b"));
}

TEST(Experiment, TimesWindowsOfThirtyFramesOrTheNextShorterLength) {
  EXPECT_EQ(timed_length({10, 30, 60}), 30);
  EXPECT_EQ(timed_length({10, 20, 60}), 20);
  EXPECT_EQ(timed_length({40, 60}), 40);
}

std::vector<int> numbers(const std::string& text, int end = 47) {
  return numbers_in(parse_ranges(text, "starts"), end);
}

TEST(Ranges, IncludeBothEndsAndRejectInvalidTextWithTheOption) {
  EXPECT_THAT(numbers("5:20:5"), ElementsAre(5, 10, 15, 20));
  EXPECT_THAT(numbers("5:19:5"), ElementsAre(5, 10, 15));
  EXPECT_THAT(numbers("3:5"), ElementsAre(3, 4, 5));
  EXPECT_THAT(numbers("7"), ElementsAre(7));
  EXPECT_THAT(numbers("30,10:20:10,20"), ElementsAre(10, 20, 30));
  EXPECT_THAT(numbers("0:end:20"), ElementsAre(0, 20, 40));
  EXPECT_THAT(numbers("0:end:20", 40), ElementsAre(0, 20, 40));
  EXPECT_THAT(numbers("5:end:5", 4), ElementsAre());
  for (const std::string& text :
       split("a|5:x:5|5:60:0|5:60:-5|60:5:5|1:2:3:4|5:|-1:3|1.5|5,,6|end|1:9999999", '|'))
    EXPECT_THAT(error_of([&] { parse_ranges(text, "lengths"); }),
                HasSubstr("lengths: '" + text + "'"));
  EXPECT_THAT(error_of([] { parse_ranges("", "lengths"); }), HasSubstr("lengths"));
}

TEST(Shards, DifferByAtMostOneWindowUnlessAStartHasManyWindows) {
  const Experiment one_start = planned({recording("a", 60)}, "5:60:5", "0");
  for (const int count : {1, 5, 8, 12, 20})
    for (int k = 1; k <= count; ++k)
      EXPECT_THAT(window_count(tasks_of(one_start, {k, count})),
                  testing::AllOf(testing::Ge(12 / count), testing::Le(12 / count + 1)))
          << k << "/" << count;
  EXPECT_THAT(tasks_of(one_start, {2, 8})[0].lengths, ElementsAre(15, 20));
  const Experiment experiment = planned({recording("a", 90)});
  for (int k = 1; k <= 4; ++k) {
    const auto tasks = tasks_of(experiment, {k, 4});
    ASSERT_EQ(tasks.size(), 1U);
    EXPECT_EQ(tasks[0].start, 10 * (k - 1));
    EXPECT_EQ(tasks[0].lengths.size(), 12U);
  }
}

TEST(Shards, AreDisjointAndComplete) {
  const Experiment experiment = planned({recording("a", 90), recording("b", 85)});
  using Window = std::tuple<std::size_t, int, int>;
  const auto add = [](std::vector<Window>& to, const std::vector<ExperimentTask>& tasks) {
    for (const ExperimentTask& task : tasks)
      for (const int frames : task.lengths) to.emplace_back(task.recording, task.start, frames);
  };
  std::vector<Window> all;
  add(all, tasks_of(experiment));
  for (const int count : {1, 5, 7, 8, 12, 20}) {
    std::vector<Window> seen;
    for (int k = 1; k <= count; ++k) add(seen, tasks_of(experiment, {k, count}));
    EXPECT_EQ(seen, all) << count;
  }
}

TEST(Shards, AreParsedFromKOfN) {
  EXPECT_EQ(parse_shard("2/8").index, 2);
  EXPECT_EQ(parse_shard("2/8").count, 8);
  for (const std::string& text :
       split("|2|2/|/8|0/8|9/8|2/8x|-1/8|a/b|2/99999999999|4294967297/4294967298", '|'))
    EXPECT_THAT(error_of([&] { parse_shard(text); }), HasSubstr("shard: '")) << text;
}

std::string refusal_of(const std::string& text) {
  return error_of([&] { parse_configurations(text); });
}

TEST(Configuration, SortsTheChangesInItsKey) {
  EXPECT_EQ(parse_configuration("gpo"), (Configuration{.method = "gpo"}));
  for (const auto& [text, key] :
       {std::pair("gpo+averaging+no-ransac", "gpo+no-ransac+averaging"),
        std::pair("ba+anchored+truth", "ba+truth+anchored"),
        std::pair("gpo+consistent+truth+anchored", "gpo+truth+anchored+consistent")}) {
    const Configuration configuration = parse_configuration(text);
    EXPECT_EQ(key_of(configuration), key);
    EXPECT_EQ(parse_configuration(key), configuration);
  }
  const Settings both = apply(parse_configuration("gpo+averaging+no-ransac"), {});
  EXPECT_EQ(both.options.ransac, false);
  EXPECT_EQ(both.options.rotations, RotationSource::averaging);
  const Settings consistent = apply(parse_configuration("gpo+consistent+anchored"), {});
  EXPECT_EQ(consistent.tracking, Tracking::anchored);
  EXPECT_EQ(consistent.options.inliers, Inliers::consistent);
}

TEST(Configuration, ChangesOptionsAndGravityIfTheMethodSupportsThem) {
  const Configuration squared =
      parse_configuration("gpo_joint+global-shutter+squared+no-time-offset");
  const Settings settings = apply(squared, {});
  EXPECT_EQ(settings.options.method_options.loss, Loss::squared);
  EXPECT_EQ(settings.options.method_options.shutter, Shutter::global);
  EXPECT_FALSE(settings.options.method_options.time_offset);
  EXPECT_EQ(key_of(squared), "gpo_joint+squared+global-shutter+no-time-offset");
  EXPECT_EQ(configuration_of(settings), squared);
  EXPECT_THAT(refusal_of("ba+huber"), HasSubstr("methods: 'ba+huber': ba does not read 'loss'"));
  const Configuration joint = parse_configuration("gpo_joint+joint-gravity");
  EXPECT_EQ(apply(joint, {}).options.gravity, Gravity::joint);
  EXPECT_EQ(configuration_of(apply(joint, {})), joint);
  EXPECT_EQ(apply(parse_configuration("ba+no-gravity"), {}).options.gravity, Gravity::off);
  EXPECT_THAT(refusal_of("ba+joint-gravity"),
              HasSubstr("'ba+joint-gravity': ba does not take 'joint' for 'gravity'"));
}

TEST(Configuration, IsTheShortestForItsSettingsRelativeToOthers) {
  const auto shortest = [](const char* text) {
    return key_of(configuration_of(apply(parse_configuration(text), {})));
  };
  for (const char* text : {"gpo+ransac", "gpo+automatic", "gpo+anchored"})
    EXPECT_EQ(shortest(text), "gpo");
  EXPECT_EQ(shortest("pnp+planes"), "pnp");
  EXPECT_EQ(shortest("closed_form+per-frame"), "closed_form+per-frame");
  Settings unread{.options = {.method = "ba"}};
  unread.options.method_options.loss = Loss::squared;
  EXPECT_EQ(key_of(configuration_of(unread)), "ba");
  Settings from;
  from.tracking = Tracking::anchored;
  from.options.ransac = false;
  for (const char* key : {"gpo", "gpo+frame-to-frame", "gpo+ransac+truth"}) {
    const Settings settings = apply(parse_configuration(key), from);
    EXPECT_EQ(key_of(configuration_of(settings, from)), key);
  }
}

TEST(Configuration, KeepsSettingsThatItDoesNotName) {
  Settings base{.start = 3, .frames = 7, .tracking = Tracking::anchored, .options = {.seed = 9}};
  base.options.method_options.loss = Loss::huber;
  Settings expected = base;
  expected.options.method = "gpo";
  expected.options.ransac = false;
  expected.options.rotations = RotationSource::truth;
  EXPECT_EQ(apply(parse_configuration("gpo+no-ransac+truth"), base), expected);
  EXPECT_EQ(apply(parse_configuration("gpo+frame-to-frame"), base).tracking,
            Tracking::frame_to_frame);
}

TEST(Configuration, BaseOfAListHasDefaultsForNamedSettingsOnly) {
  Settings settings;
  settings.tracking = Tracking::frame_to_frame;
  settings.options.ransac = false;
  const auto list = parse_configurations("gpo,gpo+no-ransac,pba");
  const Settings base = base_of(list, settings);
  EXPECT_EQ(key_of(configuration_of(apply(list[0], base))), "gpo+frame-to-frame");
  EXPECT_EQ(key_of(configuration_of(apply(list[1], base))), "gpo+no-ransac+frame-to-frame");
  EXPECT_EQ(key_of(configuration_of(apply(list[2], base))), "pba+frame-to-frame");
}

TEST(Configuration, AllStandsForEveryMethodAndTheAblationsOnce) {
  std::set<std::string> keys;
  for (const Configuration& c : parse_configurations("all")) keys.insert(key_of(c));
  for (const Method& method : methods()) EXPECT_TRUE(keys.contains(method.key)) << method.key;
  for (const std::string& ablation :
       split("gpo+no-ransac,gpo+gyro,gpo+averaging,gpo+five-point,gpo+direct,gpo+truth,ba+ransac",
             ','))
    EXPECT_TRUE(keys.contains(ablation)) << ablation;
  EXPECT_EQ(parse_configurations("gpo,gpo+averaging,gpo+ransac").size(), 2U);
  EXPECT_EQ(parse_configurations("gpo,all"), parse_configurations("all"));
}

TEST(Configuration, HasItsOwnTitleAndColor) {
  for (const auto& [key, title] :
       {std::pair("gpo+no-ransac", "GPO without RANSAC"),
        std::pair("gpo+averaging", "GPO with averaged rotations"),
        std::pair("gpo+consistent", "GPO with consistent inliers"),
        std::pair("gpo+ceres", "GPO by Ceres"),
        std::pair("ba+truth+anchored", "BA with true rotations with anchored tracks")})
    EXPECT_EQ(title_of(parse_configuration(key)), title);
  for (const char* source : ChoiceKeys<RotationSource>::keys)
    EXPECT_FALSE(title_of(parse_configuration(std::string("gpo+") + source)).empty());
  std::set<std::string> titles;
  std::set<std::uint32_t> colors;
  const auto all = parse_configurations("all");
  for (const Configuration& c : all) {
    titles.insert(title_of(c));
    colors.insert(color_of(c));
  }
  EXPECT_EQ(titles.size(), all.size());
  EXPECT_EQ(colors.size(), all.size());
}

TEST(Configuration, PresetSetsAllThatItDecidesAndRepeatedWordsAreRejected) {
  const Settings paper = apply(parse_configuration("gpo+paper"), {});
  const Settings unread = with_setting(with_setting(paper, "loss", "squared"), "shutter", "global");
  EXPECT_EQ(preset_of(with_setting(unread, "planes", "one")), Preset::paper)
      << "except for settings that gpo does not read";
  Settings frame_to_frame;
  frame_to_frame.tracking = Tracking::frame_to_frame;
  const Settings best = apply(parse_configuration("gpo_joint+best"), frame_to_frame);
  EXPECT_EQ(best.tracking, Tracking::anchored);
  EXPECT_THAT(refusal_of("gpo+paper+anchored"), HasSubstr("twice"));
  for (const auto& [text, message] :
       {std::pair("gpo,gpoo", "methods: unknown method 'gpoo', expected all or"),
        std::pair("", "methods: unknown method ''"),
        std::pair("gpo+gyr", "'gpo+gyr': unknown setting 'gyr', expected one of ransac"),
        std::pair("gpo+truth+gyro", "sets 'rotations' twice"),
        std::pair("gpo+anchored+anchored", "sets 'tracking' twice"),
        std::pair("gpo+per-frame+consistent", "sets 'inliers' twice")})
    EXPECT_THAT(refusal_of(text), HasSubstr(message));
}

}  // namespace
}  // namespace gpo::test
