// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/configuration.h"

#include "engine/frontend/tracking/tracking.h"
#include "engine/inspection/settings/settings_table.h"
#include "engine/methods/methods.h"
#include "engine/window/window.h"
#include "tests/engine/test_folder.h"

#include <set>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::error_of;
using ::testing::HasSubstr;

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

TEST(Configuration, ChangesOptionsThatTheMethodReads) {
  const Configuration squared = parse_configuration("gpo_joint+global-shutter+squared+time-offset");
  const Settings settings = apply(squared, {});
  EXPECT_EQ(settings.options.method_options.loss, Loss::squared);
  EXPECT_EQ(settings.options.method_options.shutter, Shutter::global);
  EXPECT_TRUE(settings.options.method_options.time_offset);
  EXPECT_EQ(key_of(squared), "gpo_joint+squared+global-shutter+time-offset");
  EXPECT_EQ(configuration_of(settings), squared);
  EXPECT_THAT(refusal_of("ba+huber"), HasSubstr("methods: 'ba+huber': ba does not read 'loss'"));
}

TEST(Configuration, ChangesGravityIfTheMethodSupportsIt) {
  const Configuration joint = parse_configuration("gpo_joint+joint-gravity");
  EXPECT_EQ(apply(joint, {}).options.gravity, Gravity::joint);
  EXPECT_EQ(configuration_of(apply(joint, {})), joint);
  EXPECT_EQ(apply(parse_configuration("ba+no-gravity"), {}).options.gravity, Gravity::off);
  EXPECT_THAT(refusal_of("ba+joint-gravity"),
              HasSubstr("'ba+joint-gravity': ba does not take 'joint' for 'gravity'"));
}

TEST(Configuration, IsTheShortestForItsSettings) {
  const auto shortest = [](const char* text) {
    return key_of(configuration_of(apply(parse_configuration(text), {})));
  };
  EXPECT_EQ(shortest("gpo+ransac"), "gpo");
  EXPECT_EQ(shortest("gpo+automatic"), "gpo");
  EXPECT_EQ(shortest("gpo+anchored"), "gpo");
  EXPECT_EQ(shortest("pnp+planes"), "pnp");
  EXPECT_EQ(shortest("closed_form+per-frame"), "closed_form+per-frame");
  Settings unread{.options = {.method = "ba"}};
  unread.options.method_options.loss = Loss::squared;
  EXPECT_EQ(key_of(configuration_of(unread)), "ba");
}

TEST(Configuration, IsRelativeToOtherSettings) {
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

TEST(Configuration, AllStandsForEveryMethodAndTheAblations) {
  std::set<std::string> keys;
  for (const Configuration& c : parse_configurations("all")) keys.insert(key_of(c));
  for (const Method& method : methods()) EXPECT_TRUE(keys.contains(method.key)) << method.key;
  for (const char* ablation : {"gpo+no-ransac",
                               "gpo+gyro",
                               "gpo+averaging",
                               "gpo+five-point",
                               "gpo+direct",
                               "gpo+truth",
                               "ba+ransac"})
    EXPECT_TRUE(keys.contains(ablation)) << ablation;
}

TEST(Configuration, AppearsInAListOnce) {
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

TEST(Configuration, PresetSetsAllThatItDecides) {
  const Settings paper = apply(parse_configuration("gpo+paper"), {});
  EXPECT_EQ(preset_of(with_setting(
                with_setting(with_setting(paper, "loss", "squared"), "shutter", "global"),
                "planes",
                "one")),
            Preset::paper)
      << "except for settings that gpo does not read";
  Settings frame_to_frame;
  frame_to_frame.tracking = Tracking::frame_to_frame;
  const Settings best = apply(parse_configuration("gpo_joint+best"), frame_to_frame);
  EXPECT_EQ(best.tracking, Tracking::anchored);
  EXPECT_THAT(refusal_of("gpo+paper+anchored"), HasSubstr("twice"));
}

TEST(Configuration, RejectsUnknownAndRepeatedWords) {
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
}  // namespace gpo
