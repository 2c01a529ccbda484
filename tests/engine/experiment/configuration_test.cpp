// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/configuration.h"

#include "engine/frontend/tracking/tracking.h"
#include "engine/inspection/settings/setting_values.h"
#include "engine/methods/methods.h"
#include "engine/window/window.h"
#include "tests/engine/test_folder.h"

#include <set>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::error_of;
using ::testing::HasSubstr;

TEST(Configuration, IsAMethodWithTheSettingsThatDiffer) {
  const Configuration plain = parse_configuration("gpo");
  EXPECT_EQ(plain, (Configuration{.method = "gpo"}));
  const Configuration both = parse_configuration("gpo+averaging+no-ransac");
  EXPECT_EQ(apply(both, {}).options.ransac, false);
  EXPECT_EQ(apply(both, {}).options.rotations, RotationSource::averaging);
  EXPECT_EQ(key_of(both), "gpo+no-ransac+averaging");
  EXPECT_EQ(parse_configuration(key_of(both)), both);
  const Configuration anchored = parse_configuration("ba+anchored+truth");
  EXPECT_EQ(key_of(anchored), "ba+truth+anchored");
  EXPECT_EQ(title_of(anchored), "BA with true rotations with anchored tracks");
  EXPECT_EQ(apply(anchored, {}).tracking, Tracking::anchored);
  const Configuration consistent = parse_configuration("gpo+consistent+truth+anchored");
  EXPECT_EQ(key_of(consistent), "gpo+truth+anchored+consistent");
  EXPECT_EQ(parse_configuration(key_of(consistent)), consistent);
  EXPECT_EQ(title_of(parse_configuration("gpo+consistent")), "GPO with consistent inliers");
  EXPECT_EQ(apply(consistent, {}).options.inliers, Inliers::consistent);
}

TEST(Configuration, NamesWhatAMethodReadsOfItsOptions) {
  const Configuration squared = parse_configuration("gpo_joint+global-shutter+squared+time-offset");
  const Settings settings = apply(squared, {});
  EXPECT_EQ(settings.options.method_options.loss, Loss::squared);
  EXPECT_EQ(settings.options.method_options.shutter, Shutter::global);
  EXPECT_TRUE(settings.options.method_options.time_offset);
  EXPECT_EQ(key_of(squared), "gpo_joint+squared+global-shutter+time-offset");
  EXPECT_EQ(configuration_of(settings), squared);
  EXPECT_EQ(title_of(parse_configuration("gpo+ceres")), "GPO by Ceres");
  EXPECT_THAT(error_of([] { parse_configuration("ba+huber"); }),
              HasSubstr("methods: 'ba+huber': ba does not read 'loss'"));
}

TEST(Configuration, NamesGravityWhereAMethodTakesIt) {
  const Configuration joint = parse_configuration("gpo_joint+joint-gravity");
  EXPECT_EQ(apply(joint, {}).options.gravity, Gravity::joint);
  EXPECT_EQ(configuration_of(apply(joint, {})), joint);
  EXPECT_EQ(apply(parse_configuration("ba+no-gravity"), {}).options.gravity, Gravity::off);
  EXPECT_THAT(error_of([] { parse_configuration("ba+joint-gravity"); }),
              HasSubstr("'ba+joint-gravity': ba does not take 'joint' for 'gravity'"));
}

TEST(Configuration, OfSettingsIsTheShortestThatComesToThem) {
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

TEST(Configuration, OfSettingsIsWhatLeadsToThemFromOthers) {
  Settings from;
  from.tracking = Tracking::anchored;
  from.options.ransac = false;
  for (const char* key : {"gpo", "gpo+frame-to-frame", "gpo+ransac+truth"}) {
    const Settings settings = apply(parse_configuration(key), from);
    EXPECT_EQ(key_of(configuration_of(settings, from)), key);
  }
}

TEST(Configuration, LeavesWhatItDoesNotNameAsItIs) {
  Settings anchored;
  anchored.tracking = Tracking::anchored;
  anchored.options.method_options.loss = Loss::huber;
  const Settings applied = apply(parse_configuration("gpo_joint+averaging"), anchored);
  EXPECT_EQ(applied.tracking, Tracking::anchored);
  EXPECT_EQ(applied.options.method_options.loss, Loss::huber);
  EXPECT_EQ(apply(parse_configuration("gpo+frame-to-frame"), anchored).tracking,
            Tracking::frame_to_frame);
}

TEST(Configuration, AListDiffersInWhatItNamesFromTheDefaultsAndElseFromTheSettings) {
  Settings settings;
  settings.tracking = Tracking::frame_to_frame;
  settings.options.ransac = false;
  const auto list = parse_configurations("gpo,gpo+no-ransac,pba");
  const Settings base = base_of(list, settings);
  EXPECT_EQ(key_of(configuration_of(apply(list[0], base))), "gpo+frame-to-frame");
  EXPECT_EQ(key_of(configuration_of(apply(list[1], base))), "gpo+no-ransac+frame-to-frame");
  EXPECT_EQ(key_of(configuration_of(apply(list[2], base))), "pba+frame-to-frame");
}

TEST(Configuration, ChangesOnlyItsOwnSettings) {
  const Settings base{.start = 3, .frames = 7, .options = {.method = "gpo", .seed = 9}};
  Settings expected = base;
  expected.options.ransac = false;
  expected.options.rotations = RotationSource::truth;
  EXPECT_EQ(apply(parse_configuration("gpo+no-ransac+truth"), base), expected);
}

TEST(Configuration, AllIsEveryMethodAndTheAblations) {
  std::set<std::string> keys;
  for (const Configuration& c : parse_configurations("all")) keys.insert(key_of(c));
  for (const Method& method : methods()) EXPECT_TRUE(keys.contains(method.key)) << method.key;
  for (const char* ablation : {"gpo+no-ransac",
                               "gpo+gyro",
                               "gpo+averaging",
                               "gpo+five-point",
                               "gpo+direct",
                               "gpo+truth",
                               "ba+ransac"}) {
    EXPECT_TRUE(keys.contains(ablation)) << ablation;
  }
}

TEST(Configuration, IsInAListOnce) {
  EXPECT_EQ(parse_configurations("gpo,gpo+averaging,gpo+ransac").size(), 2U);
  EXPECT_EQ(parse_configurations("gpo,all"), parse_configurations("all"));
}

TEST(Configuration, HasATitleAndAColorOfItsOwn) {
  EXPECT_EQ(title_of(parse_configuration("gpo+no-ransac")), "GPO without RANSAC");
  EXPECT_EQ(title_of(parse_configuration("gpo+averaging")), "GPO with averaged rotations");
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

TEST(Configuration, APresetIsAllThatItDecides) {
  const Settings paper = apply(parse_configuration("gpo+paper"), {});
  EXPECT_EQ(preset_of(with_setting(
                with_setting(with_setting(paper, "loss", "squared"), "shutter", "global"),
                "planes",
                "one")),
            Preset::paper)
      << "but for what gpo does not read";
  Settings frame_to_frame;
  frame_to_frame.tracking = Tracking::frame_to_frame;
  const Settings best = apply(parse_configuration("gpo_joint+best"), frame_to_frame);
  EXPECT_EQ(best.tracking, Tracking::anchored);
  EXPECT_THAT(error_of([] { parse_configuration("gpo+paper+anchored"); }), HasSubstr("twice"));
}

TEST(Configuration, EveryRotationSourceHasATitle) {
  for (const char* source : ChoiceKeys<RotationSource>::keys) {
    EXPECT_FALSE(title_of(parse_configuration(std::string("gpo+") + source)).empty());
  }
}

TEST(Configuration, NamesTheOptionAndWhatIsKnown) {
  const auto error = [](const std::string& text) {
    return error_of([&] { parse_configurations(text); });
  };
  EXPECT_THAT(error("gpo,gpoo"), HasSubstr("methods: unknown method 'gpoo', expected all, or"));
  EXPECT_THAT(error(""), HasSubstr("methods: unknown method ''"));
  EXPECT_THAT(error("gpo+gyr"),
              HasSubstr("'gpo+gyr': unknown setting 'gyr', expected one of ransac"));
  EXPECT_THAT(error("gpo+truth+gyro"), HasSubstr("sets one thing twice"));
  EXPECT_THAT(error("gpo+anchored+anchored"), HasSubstr("sets one thing twice"));
  EXPECT_THAT(error("gpo+per-frame+consistent"), HasSubstr("sets one thing twice"));
}

}  // namespace
}  // namespace gpo
