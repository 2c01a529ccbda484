// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/growth.h"

#include "engine/diagnosis/diagnosis.h"
#include "engine/diagnosis/window_evidence.h"
#include "engine/methods/initializers.h"
#include "engine/methods/methods.h"
#include "tests/engine/methods/method_cases.h"
#include "tests/engine/simulated_room.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

Simulation window_of(Motion motion, double travel, std::uint64_t seed) {
  return simulate_fitted({.motion = motion,
                          .travel = travel,
                          .off_plane = 0.15,
                          .gyro_bias_rad_s = 0.002,
                          .seed = seed});
}

Window beginning(const Window& window, int frames) {
  Window first = window;
  first.points_px.resize(frames);
  first.timestamps_ns.resize(frames);
  first.inlier.resize(frames);
  first.H_i1.resize(frames);
  first.R_wc.resize(frames);
  return first;
}

std::vector<Verdict> verdicts_of(const std::vector<GrowthStep>& steps) {
  std::vector<Verdict> numbers;
  for (const GrowthStep& step : steps) numbers.push_back(step.numbers);
  return growth_verdicts(numbers, {});
}

Verdict whole_verdict(const Simulation& of) {
  return verdicts_of(grow(of.window, Lens::exact)).back();
}

TEST(Growth, EqualsGpoAtEveryLength) {
  for (const Motion motion : kObservableMotions) {
    const Simulation truth = window_of(motion, 0.3, 5);
    const std::vector<GrowthStep> steps = grow(truth.window);
    ASSERT_EQ(steps.size(), 29);
    for (const GrowthStep& step : steps) {
      if (step.frames % 6 != 0) continue;
      const PlaneSolution alone = solve_gpo(beginning(truth.window, step.frames), {}, {});
      const double cosine = std::abs(step.normal.dot(alone.motion.normal));
      EXPECT_GT(cosine, std::cos(radians(0.002))) << step.frames;
    }
  }
}

TEST(Growth, LinearizesFewFramesPerStep) {
  for (const Motion motion : kObservableMotions) {
    int linearized = 0;
    for (const GrowthStep& step : grow(window_of(motion, 0.3, 6).window))
      linearized += step.linearized;
    EXPECT_LT(linearized, 29 * 6);  // without warm start at least 435
  }
}

TEST(Verdict, SeparatesGoodLowAndNoParallax) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const Motion motion : kObservableMotions) {
      EXPECT_EQ(whole_verdict(window_of(motion, 0.3, seed)).readiness, Readiness::ready);
      EXPECT_EQ(whole_verdict(window_of(motion, 0.04, seed)).readiness, Readiness::weak);
    }
    const Verdict none = whole_verdict(window_of(Motion::rotation_only, 0, seed));
    EXPECT_EQ(none.readiness, Readiness::degenerate);
    EXPECT_THAT(none.reason, testing::HasSubstr("rotations alone explain"));
  }
}

TEST(Verdict, ImprovesAsWindowGrows) {
  const std::vector<Verdict> steps =
      verdicts_of(grow(window_of(Motion::sideways, 0.3, 3).window, Lens::exact));
  for (std::size_t k = 5; k < steps.size(); ++k) {
    EXPECT_LT(*steps[k].normal_sigma_deg, 1.1 * *steps[k - 1].normal_sigma_deg);
    EXPECT_LE(static_cast<int>(steps[k].readiness), static_cast<int>(steps[k - 1].readiness));
  }
}

TEST(Growth, AddsATypicalLensUnlessItIsExact) {
  const Method& joint = find_method("gpo_joint");  // the bias is unknown, as in the growth
  for (const Motion motion : kObservableMotions) {
    const Window window = window_of(motion, 0.3, 4).window;
    const std::vector<GrowthStep> typical = grow(window), exact = grow(window, Lens::exact);
    for (const int frames : {20, 30}) {
      const Window first = beginning(window, frames);
      const auto alone = assessed(joint, first, joint.initialize(first, {}, {}));
      ASSERT_TRUE(alone.verdict);
      const double sigma_deg = *typical[frames - 2].numbers.normal_sigma_deg;
      EXPECT_GT(sigma_deg / *alone.verdict->normal_sigma_deg, 0.4);
      EXPECT_LT(sigma_deg / *alone.verdict->normal_sigma_deg, 2.5);
      EXPECT_GT(sigma_deg, *exact[frames - 2].numbers.normal_sigma_deg);
    }
  }
}

TEST(Growth, IsEmptyForFrameWithTooFewInliers) {
  Simulation truth = window_of(Motion::orbit, 0.3, 1);
  truth.window.inlier[7].assign(150, false);
  EXPECT_TRUE(grow(truth.window).empty());
}

std::optional<SceneCriterion> criterion_of(const Room& room) {
  return scene_criterion(room.window, room.cameras, 0.2);
}

TEST(SceneEvidence, PrefersPlanesForPlanes) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto flat = criterion_of(
        simulate_room({.planes = floor_and_walls(), .shares = {0.6, 0.4}, .seed = seed}));
    ASSERT_TRUE(flat);
    EXPECT_LT(flat->planes, flat->free_points) << seed;
  }
}

TEST(SceneEvidence, PrefersFreePointsForMostlyFreePoints) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Room room = simulate_room({.planes = floor_and_walls(), .shares = {0.3}, .seed = seed});
    const auto rough = criterion_of(room);
    if (room.window.planes.empty()) continue;
    ASSERT_TRUE(rough);
    EXPECT_LT(rough->free_points, rough->planes) << seed;
  }
}

TEST(SceneEvidence, IsEmptyWithoutPlanes) {
  const Room cloud = simulate_room({.seed = 3});
  ASSERT_TRUE(cloud.window.planes.empty());
  EXPECT_FALSE(criterion_of(cloud));
  EXPECT_EQ(scene_of(cloud.window), SceneKind::no_plane);
}

TEST(SceneEvidence, ReportsSharesAndStability) {
  const Room room = simulate_room({.planes = floor_and_walls(), .shares = {0.6, 0.4}});
  EXPECT_EQ(scene_of(room.window), SceneKind::several_planes);
  ASSERT_EQ(room.window.planes.size(), 2U);
  for (const WindowPlane& plane : room.window.planes) {
    EXPECT_GT(static_cast<double>(plane.tracks.size()) / room.window.track_count(), 0.25);
    EXPECT_GT(plane.image_share, 0.3);  // tracks cover the image
    EXPECT_LE(plane.image_share, 1);
    EXPECT_GT(plane.stability, 0.9);
  }
}

/// Returns a verdict of a growing window that only the uncertainty decides.
Verdict grown(double normal_sigma_deg) {
  const Verdict numbers{.normal_sigma_deg = normal_sigma_deg,
                        .rotation_rms_px = 5,
                        .noise_px = 0.1,
                        .largest_translation = 0.5};
  return growth_verdicts({&numbers, 1}, {}).front();
}

/// Returns the verdicts of shorter windows by the criterion of the whole window.
std::vector<Verdict> comparable(std::span<const Verdict> growth, const Verdict& whole) {
  return growth_verdicts(comparable_numbers(growth, whole), {});
}

TEST(ComparableGrowth, WidensShorterWindowsByTheRatioOfTheWholeWindow) {
  // `gpo` on sequences/companions/corner.yaml: 0.35 deg as it grows, 0.81 deg of its own.
  const std::vector<Verdict> growth = {grown(0.20), grown(0.36), grown(0.35)};
  EXPECT_EQ(growth[1].readiness, Readiness::ready);
  const Verdict whole = grown(0.81);
  const std::vector<Verdict> shown = comparable(growth, whole);
  ASSERT_EQ(shown.size(), 3U);
  EXPECT_NEAR(shown[1].normal_sigma_deg.value(), 0.36 * 0.81 / 0.35, 1e-12);
  EXPECT_EQ(shown[0].readiness, Readiness::ready);
  EXPECT_EQ(shown[1].readiness, Readiness::weak);
  EXPECT_EQ(shown[2].readiness, whole.readiness);
}

TEST(ComparableGrowth, NeverPromisesMoreThanTheGrowthItself) {
  const std::vector<Verdict> growth = {grown(2), grown(0.6)};
  const std::vector<Verdict> shown = comparable(growth, grown(0.04));
  EXPECT_DOUBLE_EQ(shown[0].normal_sigma_deg.value(), 2);
  EXPECT_EQ(shown[0].readiness, Readiness::weak);
  EXPECT_EQ(shown[1].readiness, Readiness::weak);
}

TEST(ComparableGrowth, IsEmptyWithoutAnUncertainty) {
  EXPECT_TRUE(comparable({}, grown(0.1)).empty());
  Verdict unknown = grown(0.1);
  unknown.normal_sigma_deg.reset();
  EXPECT_TRUE(comparable(std::vector{grown(0.1)}, unknown).empty());
}

}  // namespace
}  // namespace gpo::test
