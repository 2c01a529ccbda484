// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/diagnosis/diagnosis.h"

#include <limits>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

Verdict good_numbers() {
  return {
      .normal_sigma_deg = 0.1, .rotation_rms_px = 5, .noise_px = 0.1, .largest_translation = 0.5};
}

Verdict verdict_by(const Verdict& numbers) { return growth_verdicts({&numbers, 1}, {}).front(); }

TEST(Checks, HaveKeysOfTheirOwn) {
  std::set<std::string> keys;
  for (const Check& check : checks()) {
    EXPECT_TRUE(keys.insert(check.key).second) << check.key;
    EXPECT_THAT(check.key, testing::MatchesRegex("[a-z-]+"));
    EXPECT_NE(std::string(check.title), "");
  }
}

TEST(Verdict, IsReadyWithoutFindings) {
  EXPECT_EQ(verdict_by(good_numbers()).readiness, Readiness::ready);
  EXPECT_EQ(verdict_by(good_numbers()).reason, "normal uncertainty 0.10 deg (1 sigma)");
}

TEST(Verdict, IsTheHeaviestFindingInTheOrderOfTheTable) {
  Verdict numbers = good_numbers();
  numbers.normal_sigma_deg = 0.7;
  numbers.largest_translation = 0.05;
  EXPECT_THAT(verdict_by(numbers).reason, HasSubstr("little parallax"));
  numbers.normal_sigma_deg = 12;
  EXPECT_EQ(verdict_by(numbers).readiness, Readiness::degenerate);
  EXPECT_EQ(verdict_by(numbers).reason,
            "plane normal only known to 12.0 deg: use a longer camera path");
}

TEST(Verdict, IsNeverReadyByNumbersThatAreNotFinite) {
  for (const double bad : {kNaN, kInfinite}) {
    for (std::optional<double> Verdict::*field : {&Verdict::normal_sigma_deg,
                                                  &Verdict::rotation_rms_px,
                                                  &Verdict::noise_px,
                                                  &Verdict::largest_translation}) {
      Verdict numbers = good_numbers();
      numbers.*field = bad;
      const Verdict verdict = verdict_by(numbers);
      EXPECT_EQ(verdict.readiness, Readiness::degenerate);
      EXPECT_FALSE(verdict.*field);
      EXPECT_THAT(findings_of({.numbers = &numbers}, {Of::length}), SizeIs(1))
          << "no further check of such numbers";
      EXPECT_THAT(verdict.reason,
                  testing::Not(testing::AnyOf(HasSubstr("nan"), HasSubstr("inf "))));
    }
  }
}

TEST(Findings, AreSortedByLevel) {
  Verdict numbers = good_numbers();
  numbers.normal_sigma_deg = 12;
  numbers.largest_translation = 0.05;
  const auto found = findings_of({.numbers = &numbers}, {Of::length});
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_EQ(found[0].key, "uncertain-normal");
  EXPECT_EQ(found[1].key, "little-parallax") << "weak, although the table has it first";
}

TEST(GrowthVerdicts, AreLoweredByFindingsOfTheWholeWindow) {
  const std::vector<Verdict> numbers = {good_numbers(), good_numbers()};
  const std::vector<Finding> whole = {
      {.key = "implausible-intrinsics", .level = Level::weak, .sentence = "cx is 0"},
      {.key = "method-failed", .level = Level::degenerate, .sentence = "no convergence"}};
  for (const Verdict& verdict : growth_verdicts(numbers, whole)) {
    EXPECT_EQ(verdict.readiness, Readiness::weak);
    EXPECT_EQ(verdict.reason, "cx is 0");
  }
}

TEST(Interlaced, NamesTheFirstField) {
  for (const char* field : {"top", "bottom"}) {
    const auto found = findings_of({.first_field = field}, {Of::recording});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].key, "interlaced");
    EXPECT_EQ(found[0].level, Level::note);
    EXPECT_EQ(found[0].sentence,
              fmt::format("interlaced, {} field first: the first field is used", field));
  }
  EXPECT_THAT(findings_of({}, {Of::recording}), IsEmpty());
}

Camera camera_with(double fx, double fy, double cx, double cy) {
  return {.width = 640, .height = 480, .fx = fx, .fy = fy, .cx = cx, .cy = cy};
}

std::vector<Finding> found_in(const Camera& camera, std::span<const std::string> ignored = {}) {
  return findings_of({.camera = &camera}, {Of::recording}, ignored);
}

TEST(ImplausibleIntrinsics, AreNamed) {
  for (const auto& [camera, text] :
       {std::pair(camera_with(500, 500, 0, 0), "at 0 % of the width and 0 % of the height"),
        {camera_with(500, 322.5, 500, 237.5), "at 78 % of the width and 50 % of the height"},
        {camera_with(500, 560, 319.5, 239.5), "fx is 0.893 times fy"},
        {camera_with(50, 50, 319.5, 239.5), "the field of view is 162.2 deg"},
        {camera_with(9e3, 9e3, 319.5, 239.5), "the field of view is 4.1 deg"}}) {
    const auto found = found_in(camera);
    ASSERT_EQ(found.size(), 1U) << text;
    EXPECT_EQ(found[0].key, "implausible-intrinsics");
    EXPECT_EQ(found[0].level, Level::weak);
    EXPECT_THAT(found[0].sentence, HasSubstr(text));
  }
}

TEST(ImplausibleIntrinsics, NameTheSizeThatTheyWereMadeFor) {
  for (const double scale : {0.5, 0.75, 0.8, 1.5, 2.0, 0.9}) {
    // A camera of 800 x 600, slightly off the center, whose images were resized.
    const Camera camera{.width = static_cast<int>(800 * scale),
                        .height = static_cast<int>(600 * scale),
                        .fx = 640,
                        .fy = 641,
                        .cx = 404,
                        .cy = 297};
    const auto found = found_in(camera);
    ASSERT_EQ(found.size(), 1U) << scale;
    EXPECT_THAT(found[0].sentence, HasSubstr("for images of about 8")) << found[0].sentence;
    EXPECT_EQ(found[0].view, "camera");
    const auto scaled =
        findings_of({.camera = &camera, .intrinsics_scale = 2}, {Of::recording}).at(0);
    if (scale != 0.9)
      EXPECT_EQ(scaled.command, fmt::format("set intrinsics_scale {:.4g}", 2 * scale));
    if (scale != 0.9) EXPECT_THAT(scaled.advice, HasSubstr(fmt::format("by {:.4g} (", 2 * scale)));
    if (scale != 0.9) EXPECT_THAT(found[0].advice, HasSubstr(fmt::format("by {:.4g} (", scale)));
  }
}

TEST(ImplausibleIntrinsics, AreAbsentInPublishedCalibrations) {
  const Camera cameras[] = {
      {752, 480, 458.654, 457.296, 367.215, 248.375},   // EuRoC
      {1241, 376, 718.856, 718.856, 607.193, 185.216},  // KITTI 00
      {1226, 370, 707.091, 707.091, 601.887, 183.110},  // KITTI 04
      {640, 480, 517.3, 516.5, 318.6, 255.3},           // TUM RGB-D, freiburg1
      {640, 480, 520.9, 521.0, 325.1, 249.7},           // freiburg2
      {640, 480, 535.4, 539.2, 320.1, 247.6},           // freiburg3
      {512, 512, 190.978, 190.973, 254.931, 256.897, Distortion::equidistant},  // TUM-VI
      {848, 800, 284.98, 286.10, 425.24, 398.46, Distortion::equidistant},      // RealSense T265
      {1920, 1440, 1593.4, 1593.4, 953.3, 722.9},                               // a phone
  };
  for (const Camera& camera : cameras) EXPECT_THAT(found_in(camera), IsEmpty()) << camera.width;
}

TEST(ImplausibleIntrinsics, AreNotLookedForInAGuess) {
  const Camera camera = camera_with(500, 500, 0, 0);
  const auto found = findings_of({.camera = &camera, .camera_is_guess = true}, {Of::recording});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].key, "guessed-camera");
  EXPECT_EQ(found[0].level, Level::weak);
  EXPECT_THAT(found_in(Camera{}), IsEmpty()) << "the size of the images is unknown";
}

TEST(ImplausibleIntrinsics, AllowPixelsAsTheVideoStatesThem) {
  const Camera camera{720, 576, 700, 766, 359.5, 287.5};
  EXPECT_EQ(found_in(camera).size(), 1U);
  EXPECT_THAT(findings_of({.camera = &camera, .pixel_aspect = 766. / 700}, {Of::recording}),
              IsEmpty());
}

TEST(IgnoredFindings, BecomeNotes) {
  const std::vector<std::string> keys = {"implausible-intrinsics"};
  const auto found = found_in(camera_with(500, 500, 0, 0), keys);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].level, Level::note);
  EXPECT_TRUE(found[0].ignored);
}

TEST(IgnoredFindings, KeepTheirLevelIfTheyDecide) {
  Verdict numbers = good_numbers();
  numbers.largest_translation = 0.05;
  const std::vector<std::string> keys = {"little-parallax"};
  const auto found = findings_of({.numbers = &numbers}, {Of::length}, keys);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].level, Level::weak);
  EXPECT_FALSE(found[0].ignored);
}

TEST(IgnoredFindings, RefusesKeysThatNoCheckHasOrThatDecide) {
  const auto message = [](const std::string& key) -> std::string {
    try {
      check_ignored(std::vector{key});
    } catch (const SettingError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message("no-such"), HasSubstr("unknown finding 'no-such', expected some of "));
  EXPECT_THAT(message("uncertain-normal"), HasSubstr("cannot ignore 'uncertain-normal'"));
  EXPECT_EQ(message("guessed-camera"), "");
}

TEST(RepeatedTexture, IsWeakInAmbiguousFrames) {
  Tracks tracks{.start = 7, .ids = {3, 5}, .raw_px = std::vector(4, Eigen::Matrix2Xd(2, 2))};
  const auto found = [&] { return findings_of({.tracks = &tracks}, {Of::window}); };
  EXPECT_THAT(found(), IsEmpty());
  tracks.repetition = Repetition{Eigen::Matrix2Xd{{20, 0}, {0, 24}}, {kInfinite, 6, 6, 6}};
  EXPECT_THAT(found(), IsEmpty());
  tracks.repetition->margins = {kInfinite, 6, 1, 0};
  ASSERT_EQ(found().size(), 1U);
  const Finding finding = found()[0];
  EXPECT_EQ(finding.key, "repeated-texture");
  EXPECT_EQ(finding.level, Level::weak);
  EXPECT_THAT(finding.sentence, HasSubstr("every 24 px, and in 1 of 3 frames"));
  EXPECT_EQ(finding.tracks, tracks.ids);
  EXPECT_THAT(finding.frames, ElementsAre(7, 10)) << "the reference frame first";
}

}  // namespace
}  // namespace gpo::test
