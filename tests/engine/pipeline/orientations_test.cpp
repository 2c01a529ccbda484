// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/pipeline/orientations.h"

#include "engine/diagnosis/diagnosis.h"
#include "engine/initialize.h"
#include "engine/methods/initializers.h"
#include "tests/engine/methods/method_cases.h"
#include "tests/engine/pipeline/simulated_frames.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <utility>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr, testing::StartsWith;

Rotations ambiguous_rotations(const Simulation& s) {
  Rotations rotations = averaged_rotations(s.window);
  EXPECT_FALSE(rotations.R_wc_other.empty());
  return rotations;
}

MethodRun run_joint(const Simulation& s, const Rotations& rotations) {
  Window window = s.window;
  window.R_wc = rotations.R_wc;
  window.rotations = rotations.model;
  return run_from_both(
      window, rotations, [](const Window& one) { return uncertain_by("gpo_joint", one); });
}

double error_deg(const Simulation& s, const Plane& plane) {
  return angle_deg(plane.normal, s.plane.normal);
}

SimulationOptions straight(std::uint64_t seed, double reference_noise_px) {
  return {.motion = Motion::oblique,
          .noise_px = 0.15,
          .travel = 0.04,
          .reference_noise_px = reference_noise_px,
          .seed = seed};
}

std::string text_of_check(const Initialization& result, Level level) {
  const auto findings = findings_of({.result = &result}, {Of::window});
  EXPECT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings.at(0).key, "two-orientations");
  EXPECT_EQ(findings.at(0).level, level);
  return text_of(findings.at(0));
}

// With noise in the reference frame gpo_joint takes the lower one of two minima, so both starts end
// alike, half of them 32 deg off.
TEST(Orientations, KeepBothSolutionsOfAStraightPath) {
  for (const double reference_noise_px : {0.0, 0.15})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE(seed);
      const Simulation s = simulate_fitted(straight(seed, reference_noise_px));
      const Initialization result = run_joint(s, ambiguous_rotations(s)).result;
      ASSERT_TRUE(result.ok);
      ASSERT_EQ(result.ambiguity->undecided.size(), 2U);
      const RefusedSolution& first = result.ambiguity->undecided[0];
      const RefusedSolution& second = result.ambiguity->undecided[1];
      EXPECT_EQ(first.plane.normal, result.plane.normal);
      EXPECT_LT(std::min(error_deg(s, first.plane), error_deg(s, second.plane)), 3);
      EXPECT_GT(std::max(error_deg(s, first.plane), error_deg(s, second.plane)), 20);
      EXPECT_THAT(text_of_check(result, Level::degenerate), StartsWith("Ambiguous: two plane"));
    }
}

TEST(Orientations, AreDecidedByTracksOffThePlane) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    SimulationOptions options = straight(seed, 0);
    options.points = 300;
    options.travel = 0.1;
    options.off_plane = 0.2;
    const Simulation s = simulate_fitted(options);
    Rotations rotations = ambiguous_rotations(s);
    for (const bool swapped : {false, true}) {
      if (swapped) std::swap(rotations.R_wc, rotations.R_wc_other);
      const auto [window, result] = run_joint(s, rotations);
      ASSERT_TRUE(result.ok);
      EXPECT_TRUE(result.ambiguity->undecided.empty());
      ASSERT_TRUE(result.ambiguity->rejected.has_value());
      EXPECT_GT(result.ambiguity->rejected->sigmas, 5);
      EXPECT_LT(error_deg(s, result.plane), 1);
      EXPECT_THAT(text_of_check(result, Level::weak), HasSubstr("sigma"));
      const double last_deg =
          degrees(so3_log(window.R_wc[29].transpose() * s.cameras[29].R_wc).norm());
      EXPECT_LT(last_deg, 2) << "the window has the rotations of the other orientation";
    }
    Simulation guess = s;
    guess.window.camera_is_guess = true;
    EXPECT_EQ(run_joint(guess, rotations).result.ambiguity->undecided.size(), 2U);
  }
}

TEST(Orientations, AreOneIfBothEndInOneMinimum) {
  const Simulation s = simulate_fitted({.motion = Motion::approach, .travel = 0.04, .seed = 5});
  const Rotations rotations = ambiguous_rotations(s);
  const auto result = run_joint(s, rotations).result;
  ASSERT_TRUE(result.ok);
  EXPECT_TRUE(result.ambiguity->undecided.empty());
  EXPECT_FALSE(result.ambiguity->rejected.has_value());
  EXPECT_GT(result.ambiguity->apart_deg, 5);
  EXPECT_THAT(text_of_check(result, Level::note), HasSubstr("both end in the same normal"));
}

TEST(Orientations, AreWeakIfTheMethodFailsFromOne) {
  const Simulation s = simulate_fitted(straight(1, 0));
  const Rotations rotations = ambiguous_rotations(s);
  Window window = s.window;
  window.R_wc = rotations.R_wc;
  const auto [of_result, result] = run_from_both(window, rotations, [&](const Window& one) {
    return one.R_wc == rotations.R_wc ? failed("a point is behind a camera")
                                      : initialize_gpo_joint(one, {}, {});
  });
  ASSERT_TRUE(result.ok);
  EXPECT_EQ(of_result.R_wc, rotations.R_wc_other);
  EXPECT_THAT(text_of_check(result, Level::weak), HasSubstr("a point is behind a camera"));
}

TEST(Orientations, StopAfterTheFirstRun) {
  const Simulation s = simulate_fitted(straight(1, 0));
  const Rotations rotations = ambiguous_rotations(s);
  int runs = 0;
  const auto run = run_from_both(s.window, rotations, [&](const Window&) {
    ++runs;
    return stopped_early();
  });
  EXPECT_TRUE(run.result.stopped);
  EXPECT_EQ(runs, 1);
}

TEST(Orientations, FailTheWindowButKeepBothSolutions) {
  const Simulation s = simulate_fitted(straight(2, 0.15));
  const auto frames = frames_of(s.window);
  InitializeOptions options{.rotations = RotationSource::averaging};
  const WindowResult result = initialize(camera_of(s.window), frames, nullptr, options);
  const Initialization& failure = result.initialization;
  EXPECT_FALSE(failure.ok);
  EXPECT_THAT(failure.reason, StartsWith("Ambiguous: two plane orientations"));
  ASSERT_TRUE(failure.refused && failure.ambiguity);
  ASSERT_EQ(failure.ambiguity->undecided.size(), 2U);
  EXPECT_EQ(failure.ambiguity->undecided[0].plane.normal, failure.refused->plane.normal);
  EXPECT_EQ(failure.ambiguity->undecided[1].cameras.size(), frames.size());
  options.rotations = RotationSource::averaging_second;
  EXPECT_FALSE(initialize(camera_of(s.window), frames, nullptr, options).initialization.ambiguity);
}

}  // namespace
}  // namespace gpo::test
