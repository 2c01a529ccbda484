// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/settings/settings_table.h"

#include "engine/inspection/inspector.h"
#include "engine/methods/methods.h"
#include "tests/engine/test_folder.h"

#include <set>
#include <tuple>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

/// Returns a value other than the one that `base` uses.
std::string other_value(const Setting& setting, const Settings& base = {}) {
  const SettingValue normal = setting.used != nullptr ? setting.used(base) : setting.get(base);
  switch (setting.kind) {
    case SettingKind::on_off:
      return value_text(normal) == "on" ? "off" : "on";
    case SettingKind::whole:
    case SettingKind::number:
      return value_text(normal) == "7" ? "8" : "7";
    case SettingKind::choice:
      return value_text(normal) == setting.choices.back().key ? setting.choices.front().key
                                                              : setting.choices.back().key;
    case SettingKind::ids:
      return "3,17";
    case SettingKind::keys:
      return "guessed-camera";
    case SettingKind::point_pair:
      return "1,2.5,3,4,17";
    case SettingKind::masks:
      return "not:1,2.5,3,4/plane:0,0,40,0,40,20";
  }
  return "";
}

TEST(SettingsTable, HasCompleteUniqueRowsWordsAndTheOptionsThatMethodsRead) {
  std::set<std::string> keys;
  for (const Setting& setting : settings_table()) {
    EXPECT_TRUE(keys.insert(setting.key).second) << setting.key;
    EXPECT_FALSE(setting.title.empty() || setting.help.empty()) << setting.key;
    EXPECT_EQ(setting.kind == SettingKind::choice, !setting.choices.empty()) << setting.key;
    const bool by_method = setting.optional && setting.kind != SettingKind::number;
    EXPECT_EQ(by_method, setting.used != nullptr) << setting.key;
    const bool number = setting.kind == SettingKind::whole || setting.kind == SettingKind::number;
    EXPECT_EQ(number, setting.least < setting.most) << setting.key;
  }
  for (const Setting& setting : settings_table()) {
    const Settings changed = with_setting({}, setting.key, other_value(setting));
    for (const Setting& one : settings_table())
      EXPECT_EQ(one.get(changed) != one.get(Settings{}), one.key == setting.key)
          << setting.key << " " << one.key;
  }
  std::set<std::string> words;
  std::set<std::uint32_t> colors;
  for (const Method& method : methods()) colors.insert(method.rgb);
  for (const Setting& setting : settings_table()) {
    for (const SettingWord& word : setting.words) {
      EXPECT_TRUE(words.insert(word.word).second) << word.word;
      EXPECT_TRUE(colors.insert(word.rgb).second) << word.word;
      EXPECT_EQ(setting_text(with_setting({}, setting.key, word.value), setting.key), word.value);
    }
    const std::size_t values = setting.kind == SettingKind::on_off ? 2 : setting.choices.size();
    if (!setting.words.empty()) {
      EXPECT_EQ(setting.words.size(), values) << setting.key;
    }
  }
  for (const Method& method : methods())
    for (const std::string& option : method.reads)
      EXPECT_EQ(find_setting(option).reader, SettingReader::method) << method.key;
  for (const Setting& setting : settings_table())
    EXPECT_EQ(setting.reader == SettingReader::method, !readers_of(setting.key).empty())
        << setting.key;
}

TEST(SettingValues, SurviveTextAndBack) {
  Settings settings;
  for (const Setting& setting : settings_table())
    settings = with_setting(settings, setting.key, other_value(setting));
  Settings read;
  for (const std::string& key : setting_keys())
    read = with_setting(read, key, setting_text(settings, key));
  EXPECT_EQ(read, settings);
  EXPECT_NE(read, Settings{});
  for (const std::string& key : setting_keys()) read = with_default(read, key);
  EXPECT_EQ(read, Settings{});
  EXPECT_EQ(setting_text({}, "ransac"), "default");
}

TEST(SettingValues, RejectInvalidTextByNameAndSortExcludedTracks) {
  const auto refusal = [](const std::string& key, const std::string& text) {
    return error_of([&] { with_setting({}, key, text); });
  };
  EXPECT_EQ(refusal("frames", "1"), "frames: '1', expected a whole number from 2 to 1000");
  EXPECT_EQ(refusal("frames", "2.5"), "frames: '2.5', expected a whole number from 2 to 1000");
  EXPECT_EQ(refusal("ransac_threshold_px", "nan"),
            "ransac_threshold_px: 'nan', expected a number from 0.1 to 50");
  EXPECT_EQ(refusal("ransac", "yes"), "ransac: 'yes', expected on or off");
  EXPECT_EQ(refusal("time_offset", "default"), "time_offset: 'default', expected on or off");
  EXPECT_EQ(refusal("loss", "cauchy"),
            "loss: unknown value 'cauchy', expected one of squared, huber");
  EXPECT_THAT(refusal("method", "gpoo"), HasSubstr("method: unknown value 'gpoo'"));
  EXPECT_THAT(refusal("exclude", "3,x"), HasSubstr("exclude: 'x', expected a whole number"));
  EXPECT_THAT(refusal("nonsense", "3"), HasSubstr("unknown setting 'nonsense'"));
  EXPECT_THROW(with_setting({}, "frames", "1"), SettingError);
  EXPECT_EQ(with_setting({}, "exclude", "9,3,9").exclude, (std::vector<std::int64_t>{3, 9}));
  EXPECT_TRUE(with_setting({.exclude = {3}}, "exclude", "none").exclude.empty());
}

TEST(SettingValues, ReportWhyTheyHaveNoEffect) {
  const auto why = [](const Settings& settings, const std::string& key) {
    return why_idle(find_setting(key), settings, nullptr);
  };
  Settings settings{.options = {.method = "gpo"}};
  for (const char* key : {"start", "method", "ransac_threshold_px", "inliers", "solver"})
    EXPECT_EQ(why(settings, key), "") << key;
  for (const char* key : {"error", "loss", "shutter", "planes", "time_offset"})
    EXPECT_EQ(why(settings, key), "Applies only to gpo_joint") << key;
  settings.options.ransac = false;
  for (const char* key : {"ransac_threshold_px", "inliers"})
    EXPECT_THAT(why(settings, key), HasSubstr("RANSAC"));
  settings.options.method = "ba";  // uses all tracks, and still counts inliers
  EXPECT_EQ(why(settings, "ransac_threshold_px"), "");
  EXPECT_EQ(why(settings, "solver"), "Applies only to gpo and gpo_joint");
  EXPECT_EQ(why(settings, "gravity"), "");
  settings.options.gravity = Gravity::joint;
  EXPECT_THAT(why(settings, "gravity"), HasSubstr("Only gpo_joint estimates gravity"));
  EXPECT_EQ(as_used(settings).options.gravity, Gravity::after);
  Recording recording;
  EXPECT_EQ(why_idle(find_setting("tracking"), settings, &recording), "");
  recording.tracks.emplace_back();
  EXPECT_THAT(why_idle(find_setting("tracking"), settings, &recording), HasSubstr("own tracks"));
}

TEST(SettingValues, ReportChangesWithoutEffect) {
  Recording recording;
  const auto expect_idle = [&](const std::string& key, Settings settings, const char* reason) {
    EXPECT_EQ(why_idle(find_setting(key), Settings{}, &recording), "") << key;
    EXPECT_THAT(why_idle(find_setting(key), settings, &recording), HasSubstr(reason)) << key;
  };
  expect_idle("accelerometer_bias_sigma",
              {.options = {.gravity = Gravity::off, .accelerometer_bias_sigma_m_s2 = 0.1}},
              "Gravity is not estimated");
  expect_idle("scale_length_sigma", {.scale_length_sigma = 0.1}, "no scale points");
  expect_idle("scale_length", {.scale_length = 0.3}, "no scale points");
  expect_idle("world_up", {.world_up = WorldUp::gravity}, "no world points");
  Settings truth{.options = {.rotations = RotationSource::truth}};
  truth.options.method_options.time_offset = false;
  expect_idle("time_offset", truth, "not from a gyroscope");
  recording.gyroscope.emplace();
  truth.options.rotations = RotationSource::gyro;
  EXPECT_EQ(why_idle(find_setting("time_offset"), truth, &recording), "");
  const Settings exact{.options = {.lens = Lens::exact}};
  EXPECT_EQ(why_idle(find_setting("lens"), exact, &recording), "");
  recording.camera.sigmas = {0, 0, 0, 0};
  EXPECT_EQ(why_idle(find_setting("lens"), exact, &recording), "");
  recording.camera.sigmas = {1, 1, 1, 1};
  expect_idle("lens", exact, "states its standard deviations");
  Method imported = find_method("gpo");
  imported.result = "x=a.txt";
  const MethodChoice own(std::make_shared<const Method>(imported));
  expect_idle("ransac", {.options = {.method = own, .ransac = false}}, "another program");
}

TEST(SettingValues, HaveEqualNormalFormsForEqualResultsAndAffectOnlyLaterStages) {
  Settings settings{.options = {.method = "ba"}};
  settings.options.ransac = false;
  settings.options.inliers = Inliers::planes;
  settings.options.method_options.loss = Loss::squared;
  EXPECT_EQ(as_used(settings), as_used({.options = {.method = "ba"}}));
  settings.options.method = "gpo_joint";
  EXPECT_EQ(as_used(settings).options.method_options.loss, Loss::squared);
  using enum SettingStage;
  for (const Setting& setting : settings_table()) {
    if (setting.key == "method") continue;  // also determines RANSAC and inliers
    const Settings base{.options = {.method = "gpo_joint"}};
    const Settings changed = with_setting(base, setting.key, other_value(setting, base));
    for (const SettingStage stage : {tracks, inliers, rotations, initialization})
      EXPECT_EQ(acting_until(stage, changed) != acting_until(stage, base), setting.stage <= stage)
          << setting.key;
  }
  EXPECT_EQ(acting_until(rotations, {.options = {.method = "gpo"}}),
            acting_until(rotations, {.options = {.method = "pnp"}}));
  EXPECT_NE(acting_until(inliers, {.options = {.method = "gpo"}}),
            acting_until(inliers, {.options = {.method = "ba"}}));
}

TEST(RotationSources, ReportWhatTheRecordingLacks) {
  Recording recording;
  recording.name = "desk";
  recording.gyroscope = Gyroscope{};
  recording.truth = GroundTruth{};
  for (const char* key : ChoiceKeys<RotationSource>::keys)
    EXPECT_EQ(why_no_rotations(recording, choice<RotationSource>(key)), "") << key;
  recording.gyroscope.reset();
  recording.truth.reset();
  EXPECT_EQ(why_no_rotations(recording, RotationSource::automatic), "");
  EXPECT_EQ(why_no_rotations(recording, RotationSource::averaging), "");
  EXPECT_EQ(why_no_rotations(recording, RotationSource::gyro), "desk has no gyroscope");
  recording.board = Board{};  // without images
  EXPECT_THAT(why_no_rotations(recording, RotationSource::truth), HasSubstr("no ground truth"));
  EXPECT_THROW(rotation_source_used(recording, RotationSource::truth), SettingError);
}

TEST(Presets, AreTheDefaultsAndThePaperAndKeepTheWindow) {
  EXPECT_EQ(with_preset({}, Preset::best), Settings{});
  EXPECT_EQ(preset_of({}), Preset::best);
  const Settings paper = with_preset({}, Preset::paper);
  EXPECT_EQ(preset_of(paper), Preset::paper);
  EXPECT_EQ(paper.options.method, "gpo");
  for (const auto& [key, value] : {std::pair("tracking", "frame-to-frame"),
                                   {"inliers", "per-frame"},
                                   {"rotations", "raw"},
                                   {"solver", "ceres"}})
    EXPECT_EQ(setting_text(paper, key), value);
  EXPECT_EQ(preset_of(with_setting(paper, "solver", "schur")), std::nullopt);
  const Settings settings{.start = 7, .frames = 12, .exclude = {3}, .options = {.seed = 5}};
  const Settings windowed = with_preset(settings, Preset::paper);
  EXPECT_EQ(with_preset(windowed, Preset::best), settings);
  EXPECT_EQ(std::tuple(windowed.start, windowed.frames, windowed.exclude),
            std::tuple(7, 12, settings.exclude));
}

}  // namespace
}  // namespace gpo::test
