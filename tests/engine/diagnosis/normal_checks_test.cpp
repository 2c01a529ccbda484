// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/diagnosis.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr, testing::IsEmpty, testing::SizeIs;

Verdict moved_numbers(double normal_sigma_deg, double largest_translation = 0.5) {
  return {.normal_sigma_deg = normal_sigma_deg,
          .rotation_rms_px = 5,
          .noise_px = 0.1,
          .largest_translation = largest_translation};
}

std::vector<Finding> found_by(const Verdict& numbers,
                              const Uncertainty& uncertainty,
                              bool camera_is_guess = false) {
  Initialization result;
  result.ok = true;
  result.uncertainty = uncertainty;
  return findings_of({.camera_is_guess = camera_is_guess, .numbers = &numbers, .result = &result},
                     {Of::length, Of::result});
}

struct Cause {
  const char* key;
  Uncertainty uncertainty;
  const char* text;
};

TEST(NormalChecks, NameTheMainCauseOfALargeUncertainty) {
  const Cause causes[] = {
      {"late-clock", {.clock_sigma_deg = 0.8, .late_s = 0.013}, "about +13 ms off"},
      {"rolling-shutter",
       {.shutter_sigma_deg = 0.8, .neglected_row_delay_s = 40e-6},
       "40.0 us from row to row"},
      {"uneven-surface", {.bend_sigma_deg = 0.8}, "varies by 0.80 deg over the plane"},
      {"regions-disagree", {.neighbors_sigma_deg = 0.8}, "disagree by 0.80 deg"}};
  for (Cause cause : causes) {
    cause.uncertainty.normal_sigma_deg = 1;
    const auto found = found_by(moved_numbers(1), cause.uncertainty);
    ASSERT_THAT(found, SizeIs(2)) << cause.key;
    EXPECT_EQ(found[0].key, cause.key);
    EXPECT_EQ(found[0].level, Level::weak);
    EXPECT_THAT(found[0].sentence, HasSubstr(cause.text));
    EXPECT_EQ(found[1].key, "uncertain-normal");
    EXPECT_THAT(found_by(moved_numbers(0.4), cause.uncertainty), IsEmpty()) << cause.key;
    cause.uncertainty.normal_sigma_deg = 2;
    EXPECT_THAT(found_by(moved_numbers(2), cause.uncertainty), SizeIs(1)) << "not the main cause";
  }
}

TEST(NormalChecks, NameATypicalLensUnlessTheCameraIsAGuess) {
  const Uncertainty uncertainty{.normal_sigma_deg = 0.1};
  const auto found = found_by(moved_numbers(1), uncertainty);
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_EQ(found[0].key, "uncertain-lens");
  EXPECT_THAT(found[0].sentence, HasSubstr("1.00 deg with a typical calibration (0.10 deg"));
  const auto guess = found_by(moved_numbers(1), uncertainty, true);
  ASSERT_THAT(guess, SizeIs(1));
  EXPECT_EQ(guess[0].key, "uncertain-normal");
  EXPECT_EQ(guess[0].advice, "the camera is a guess, calibrate it");
}

TEST(NormalChecks, TakeAnUnevenSurfaceAsWeakUpToTwelveDegrees) {
  const auto heaviest_of = [](double sigma_deg) {
    const Uncertainty bent{.normal_sigma_deg = sigma_deg, .bend_sigma_deg = sigma_deg - 0.1};
    return heaviest(found_by(moved_numbers(sigma_deg), bent));
  };
  EXPECT_EQ(heaviest_of(11.5), Level::weak);
  EXPECT_EQ(heaviest_of(12.5), Level::degenerate);
}

TEST(NormalChecks, AreDegenerateWithoutParallaxOrUncertainty) {
  const Uncertainty none;
  const auto still = found_by(moved_numbers(0.1, 0.014), none);
  ASSERT_THAT(still, SizeIs(1));
  EXPECT_EQ(still[0].key, "little-parallax");
  EXPECT_EQ(still[0].level, Level::degenerate);
  Verdict unknown = moved_numbers(1);
  unknown.normal_sigma_deg.reset();
  const auto found = findings_of({.numbers = &unknown}, {Of::length});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].level, Level::degenerate);
  EXPECT_EQ(found[0].sentence, "the window does not determine the plane normal");
  Verdict turning = moved_numbers(0.1);
  turning.rotation_rms_px = 0.12;
  EXPECT_EQ(findings_of({.numbers = &turning}, {Of::length}).at(0).key, "rotation-only");
}

TEST(ComparableNumbers, AreScaledToTheUncertaintyOfTheWholeWindow) {
  const std::vector<Verdict> growth = {moved_numbers(4), moved_numbers(0.2)};
  const auto scaled = comparable_numbers(growth, moved_numbers(0.6));
  ASSERT_THAT(scaled, SizeIs(2));
  EXPECT_NEAR(*scaled[0].normal_sigma_deg, 12, 1e-9);
  EXPECT_NEAR(*scaled[1].normal_sigma_deg, 0.6, 1e-9);
  EXPECT_EQ(comparable_numbers(growth, moved_numbers(0.1))[0].normal_sigma_deg, 4);
  EXPECT_THAT(comparable_numbers({}, moved_numbers(0.1)), IsEmpty());
}

TEST(ResultChecks, SayWhyThereIsNoPlaneAndNoResult) {
  Window window;
  window.inliers = Inliers::planes;
  Initialization failure = failed("12 tracks are too few");
  Verdict numbers;
  Evidence evidence{.window = &window, .numbers = &numbers, .result = &failure};
  const auto no_plane = findings_of(evidence, {Of::window});
  ASSERT_THAT(no_plane, SizeIs(1));
  EXPECT_EQ(no_plane[0].level, Level::no_plane);
  EXPECT_EQ(no_plane[0].sentence, "12 tracks are too few");
  EXPECT_EQ(verdict_of(no_plane, evidence).scene, SceneKind::no_plane);
  EXPECT_EQ(findings_of(evidence, {Of::result}).at(0).level, Level::degenerate);
  numbers.noise_px = 0.2;
  const auto judged_one = findings_of(evidence, {Of::result});
  ASSERT_THAT(judged_one, SizeIs(1));
  EXPECT_EQ(judged_one[0].level, Level::weak);
  EXPECT_EQ(judged_one[0].sentence, "the method failed: 12 tracks are too few");
}

TEST(ResultChecks, NameAnUnstableMethod) {
  Initialization result;
  result.ok = true;
  result.own_noise = NoiseSpread{};
  EXPECT_THAT(findings_of({.result = &result}, {Of::result}), IsEmpty());
  result.own_noise->unstable = true;
  const auto found = findings_of({.result = &result}, {Of::result});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].key, "unstable-method");
  EXPECT_EQ(found[0].level, Level::weak);
}

TEST(Remarks, BecomeNotesOfTheirOwnCheck) {
  const std::vector<Remark> remarks = {
      {"faulty-frames", "frames 3 and 4 are the same", "drop one"}};
  const auto found = findings_of({.remarks = remarks}, {Of::window, Of::inspection});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].key, "faulty-frames");
  EXPECT_EQ(found[0].level, Level::note);
  EXPECT_EQ(text_of(found[0]), "frames 3 and 4 are the same: drop one");
}

}  // namespace
}  // namespace gpo::test
