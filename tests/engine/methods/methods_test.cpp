// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/methods.h"

#include "engine/base/error.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/initializers.h"
#include "tests/engine/methods/method_cases.h"
#include "tests/engine/pipeline/simulated_frames.h"

#include <array>
#include <cstddef>
#include <functional>
#include <numeric>
#include <set>

#include <gmock/gmock.h>
#include <pthread.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

class EveryMethod : public testing::TestWithParam<Method> {
 protected:
  static Initialization run(const Window& window) { return GetParam().initialize(window, {}, {}); }

  /// If a camera approaches a plane along its normal, the two decompositions of its homographies
  /// coincide; a method that also estimates rotations then finds the normal only to the root of the
  /// noise.
  static bool moves_rotations() {
    return std::set<std::string>{"ba", "pnp_ba", "pba"}.contains(GetParam().key);
  }
};

struct Errors {
  double normal_deg = 0;
  double rotation_deg = 0;  ///< largest of all cameras
  double center = 0;        ///< largest of all cameras [plane distance]
};

Errors errors_of(const Initialization& result, const Simulation& truth) {
  Errors errors{normal_error_deg(result, truth)};
  for (std::size_t i = 0; i < truth.cameras.size(); ++i) {
    const Eigen::Matrix3d dR = result.cameras[i].R_wc.transpose() * truth.cameras[i].R_wc;
    errors.rotation_deg = std::max(errors.rotation_deg, degrees(so3_log(dR).norm()));
    const double off = (result.cameras[i].p_wc - truth.cameras[i].p_wc).norm();
    errors.center = std::max(errors.center, off);
  }
  return errors;
}

constexpr Motion kMethodMotions[] = {
    Motion::sideways, Motion::orbit, Motion::approach, Motion::oblique, Motion::wander};

void expect_exact(const Initialization& result, const Simulation& truth) {
  ASSERT_TRUE(result.ok) << result.reason;
  const Errors errors = errors_of(result, truth);
  EXPECT_LT(errors.normal_deg, 1e-4);
  EXPECT_LT(errors.rotation_deg, 1e-4);
  EXPECT_LT(errors.center, 1e-5);
  EXPECT_LT(result.rms_px, 1e-3);
}

/// Runs on a thread whose stack is below the heap; that of the main thread is above.
void run_below_the_heap(std::function<void()> action) {
  alignas(4096) static std::array<std::byte, std::size_t{8} << 20> stack;
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstack(&attributes, stack.data(), stack.size());
  const auto run = [](void* given) -> void* {
    (*static_cast<std::function<void()>*>(given))();
    return nullptr;
  };
  pthread_t thread{};
  ASSERT_EQ(pthread_create(&thread, &attributes, run, &action), 0);
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
}

TEST_P(EveryMethod, GivesTheSameBitsWhereverItsStackIs) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Window window = simulate({.motion = Motion::orbit, .frames = 8, .seed = seed}).window;
    for (const Solver solver : {Solver::schur, Solver::ceres}) {
      const auto solve = [&] { return GetParam().initialize(window, {.solver = solver}, {}); };
      const Initialization above = solve();
      Initialization below;
      run_below_the_heap([&] { below = solve(); });
      expect_same(above, below);
    }
  }
}

TEST_P(EveryMethod, IsExactWithoutNoise) {
  for (const Motion motion : kMethodMotions)
    for (const double off_plane : {0.0, 0.3})
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE(testing::Message()
                     << "motion " << static_cast<int>(motion) << " seed " << seed);
        const Simulation truth =
            simulate({.motion = motion, .noise_px = 0, .off_plane = off_plane, .seed = seed});
        expect_exact(run(truth.window), truth);
      }
}

TEST_P(EveryMethod, IsAccurateWithHalfPixelOfNoise) {
  for (const Motion motion : kMethodMotions)
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      SCOPED_TRACE(testing::Message() << "motion " << static_cast<int>(motion) << " seed " << seed);
      const Simulation truth = simulate_fitted({.motion = motion, .seed = seed});
      const Initialization result = successful(run(truth.window));
      const Errors errors = errors_of(result, truth);
      const bool flat = motion == Motion::approach && moves_rotations();
      EXPECT_LT(errors.normal_deg, flat ? 4 : 1.5);
      EXPECT_LT(errors.rotation_deg, flat ? 1.5 : 1);
      EXPECT_LT(errors.center, 0.02);
      EXPECT_LT(result.rms_px, 1);
    }
}

TEST_P(EveryMethod, ReturnsDocumentedGauge) {
  const Simulation truth = simulate({.motion = Motion::orbit});
  const Initialization result = successful(run(truth.window));
  EXPECT_EQ(result.plane.distance, 1);
  EXPECT_NEAR(result.plane.normal.norm(), 1, 1e-12);
  EXPECT_LT(result.plane.normal.z(), 0);
  EXPECT_EQ(result.cameras.size(), 30U);
  EXPECT_EQ(result.cameras[0].p_wc.norm(), 0);
  EXPECT_TRUE(result.cameras[0].R_wc.isIdentity(1e-12));
  EXPECT_EQ(result.points.size(), 150U);
  for (const MapPoint& point : result.points)
    EXPECT_NEAR(truth.plane.normal.dot(point.position) + 1, 0, 0.1);
}

TEST_P(EveryMethod, RejectsPureRotation) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Simulation truth = simulate({.motion = Motion::rotation_only, .seed = seed});
    const Initialization result = run(truth.window);
    EXPECT_FALSE(result.ok);
    EXPECT_THAT(result.reason, HasSubstr("no parallax"));
    EXPECT_TRUE(result.cameras.empty());
    EXPECT_TRUE(result.points.empty());
  }
}

TEST_P(EveryMethod, RejectsTooFewTracks) {
  const Initialization result = run(simulate({.points = 7}).window);
  EXPECT_FALSE(result.ok);
  EXPECT_EQ(result.reason,
            "too few tracks: frame 0, the first of the window, has 7, at least 8 are needed");
}

TEST_P(EveryMethod, RepeatsExactly) {
  const Simulation truth = simulate({.motion = Motion::wander});
  const Initialization a = run(truth.window);
  const Initialization b = run(truth.window);
  EXPECT_EQ(a.plane.normal, b.plane.normal);
  EXPECT_EQ(a.rms_px, b.rms_px);
  for (std::size_t i = 0; i < a.cameras.size(); ++i) {
    EXPECT_EQ(a.cameras[i].R_wc, b.cameras[i].R_wc);
    EXPECT_EQ(a.cameras[i].p_wc, b.cameras[i].p_wc);
  }
}

TEST_P(EveryMethod, IsIndependentOfOrderOfTracks) {
  const Simulation truth = simulate({.motion = Motion::orbit, .off_plane = 0.2});
  const Initialization a = run(truth.window);
  const Initialization b = run(with_reversed_tracks(truth.window));
  ASSERT_TRUE(a.ok && b.ok) << a.reason << b.reason;
  EXPECT_LT(angle_deg(a.plane.normal, b.plane.normal), 0.02);
  for (std::size_t i = 0; i < a.cameras.size(); ++i)
    EXPECT_LT((a.cameras[i].p_wc - b.cameras[i].p_wc).norm(), 1e-3);
}

TEST_P(EveryMethod, IsExactWithHiddenTracksAndForTwoFrames) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Simulation hidden = simulate({.motion = Motion::orbit, .noise_px = 0, .seed = seed});
    hide_tracks(hidden.window, 0, 60);
    expect_exact(run(hidden.window), hidden);
    const Simulation two = simulate({.frames = 2, .noise_px = 0, .seed = seed});
    expect_exact(run(two.window), two);
  }
}

TEST_P(EveryMethod, DescribesItsAssumptions) { EXPECT_THAT(GetParam().help, HasSubstr("Assumes")); }

INSTANTIATE_TEST_SUITE_P(Table,
                         EveryMethod,
                         testing::ValuesIn(methods().begin(), methods().end()),
                         [](const auto& p) { return p.param.key; });

TEST(Methods, HaveUniqueKeysTitlesAndColors) {
  std::set<std::string> keys, titles;
  std::set<std::uint32_t> colors;
  for (const Method& method : methods()) {
    keys.insert(method.key);
    titles.insert(method.title);
    colors.insert(method.rgb);
    EXPECT_EQ(&find_method(method.key), &method);
  }
  EXPECT_EQ(keys.size(), methods().size());
  EXPECT_EQ(titles.size(), methods().size());
  EXPECT_EQ(colors.size(), methods().size());
}

TEST(Methods, ListKnownKeysForUnknownKey) {
  EXPECT_THAT([] { find_method("orb"); },
              testing::ThrowsMessage<InputError>(HasSubstr("'orb', expected one of gpo, ")));
}

TEST(MethodTable, FindsOurAndUsersMethods) {
  MethodTable table;
  table.add(Method{.key = "mine", .title = "mine"});
  const MethodTable copy = table;
  EXPECT_EQ(table.all().size(), methods().size() + 1);
  EXPECT_EQ(&copy.find("mine").row(), &table.find("mine").row()) << "copies share their rows";
  EXPECT_EQ(table.find("gpo"), MethodChoice("gpo"));
  EXPECT_EQ(&table.find("gpo").row(), &find_method("gpo"));
  EXPECT_NE(table.find("mine"), MethodChoice("mine")) << "a key of ours";
  EXPECT_THROW(MethodChoice("mine").row(), SettingError);
  EXPECT_THROW(MethodTable().find("mine"), SettingError);
}

TEST(MethodTable, RejectsDuplicateKey) {
  MethodTable table;
  table.add(Method{.key = "mine"});
  EXPECT_THROW(table.add(Method{.key = "mine"}), InputError);
  EXPECT_THROW(table.add(Method{.key = "gpo"}), InputError);
  table.add(table.find("mine"));
  EXPECT_EQ(table.own().size(), 1U);
}

Initialization no_start(const Window& /*unused*/, const Watch& /*unused*/) {
  Initialization result = failed("no start");
  result.candidates.resize(3);
  return result;
}

Initialization some_start(const Window& /*unused*/, const Watch& /*unused*/) {
  Initialization result;
  result.ok = true;
  result.candidates.resize(2);
  return result;
}

Initialization refine(const Window& /*unused*/,
                      const Initialization& start,
                      const Watch& /*unused*/) {
  Initialization result;
  result.ok = start.ok;
  result.rms_px = 0.5;
  return result;
}

TEST(RefinedStart, ReturnsRefinementOrReasonWithCandidatesOfStart) {
  const Window window = simulate({}).window;
  const Initialization refined = refined_start(window, {"Some", some_start}, refine, {});
  EXPECT_TRUE(refined.ok);
  EXPECT_EQ(refined.rms_px, 0.5);
  EXPECT_EQ(refined.candidates.size(), 2U);
  const Initialization none = refined_start(window, {"None", no_start}, refine, {});
  EXPECT_FALSE(none.ok);
  EXPECT_EQ(none.reason, "start by None: no start");
  EXPECT_EQ(none.candidates.size(), 3U);
}

TEST(RefinedStart, ReportsStoppedStartAsStopped) {
  const Window window = simulate({}).window;
  const Initialization result =
      refined_start(window, {"DBSCAN", initialize_dbscan}, refine, stopped());
  EXPECT_TRUE(result.stopped);
  EXPECT_EQ(result.reason, "stopped");
  EXPECT_TRUE(initialize_pnp(window, stopped()).stopped);
  EXPECT_FALSE(refined_start(window, {"None", no_start}, refine, {}).stopped);
}

TEST(RefinedStart, ReportsMissingParallaxItself) {
  const Window window = simulate({.motion = Motion::rotation_only}).window;
  const Initialization result = refined_start(window, {"None", no_start}, refine, {});
  EXPECT_FALSE(result.ok);
  EXPECT_THAT(result.reason, testing::StartsWith("no parallax"));
}

struct TracedCase {
  std::string method;
  Solver solver = Solver::schur;
};

std::vector<TracedCase> cases() {
  std::vector<TracedCase> all;
  for (const Method& method : methods()) {
    all.push_back({method.key});
    if (method.key.starts_with("gpo")) all.push_back({method.key, Solver::ceres});
  }
  return all;
}

class EveryTrace : public testing::TestWithParam<TracedCase> {
 protected:
  static Initialization run(const Window& window) {
    // Ceres omits the last steps within its tolerance in each round of weights.
    const Loss loss = GetParam().solver == Solver::ceres ? Loss::squared : Loss::huber;
    return find_method(GetParam().method)
        .initialize(window, {.solver = GetParam().solver, .loss = loss}, {});
  }
  static bool optimizes() {
    return !std::set<std::string>{"pnp", "dbscan", "closed_form"}.contains(GetParam().method);
  }
  static bool over_a_plane() {
    return std::set<std::string>{"gpo", "gpo_joint", "pba", "fpba"}.contains(GetParam().method);
  }
};

void expect_from_initial_to_final_cost(const SolverReport& solver) {
  EXPECT_NEAR(solver.trace.front().cost, solver.initial_cost, 1e-9 * solver.initial_cost);
  EXPECT_NEAR(solver.trace.back().cost, solver.final_cost, 1e-9 * solver.final_cost);
  EXPECT_LE(static_cast<int>(solver.trace.size()), solver.iterations + 1);
  EXPECT_EQ(solver.trace.front().step, 0);
}

void expect_descent(const SolverReport& solver) {
  for (std::size_t k = 1; k < solver.trace.size(); ++k)
    EXPECT_LE(solver.trace[k].cost, solver.trace[k - 1].cost * (1 + 1e-9)) << "iteration " << k;
  if (solver.trace.front().gradient < 1e-6) return;  // gpo_joint from GPO with known rotations
  EXPECT_LT(solver.trace.back().gradient, 1e-2 * solver.trace.front().gradient);
  EXPECT_GT(solver.trace[1].step, solver.trace.back().step);
}

TEST_P(EveryTrace, ContainsStartAndResult) {
  for (const Motion motion : {Motion::sideways, Motion::orbit, Motion::wander})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(testing::Message() << "motion " << static_cast<int>(motion) << " seed " << seed);
      const Simulation truth = simulate_fitted({.motion = motion, .off_plane = 0.1, .seed = seed});
      const Initialization result = successful(run(truth.window));
      ASSERT_EQ(!result.solver.trace.empty(), optimizes());
      if (!optimizes()) continue;
      expect_from_initial_to_final_cost(result.solver);
      expect_descent(result.solver);
      for (const SolverStep& step : result.solver.trace)
        EXPECT_EQ(step.normal.has_value(), over_a_plane());
      if (over_a_plane()) {
        EXPECT_EQ(*result.solver.trace.back().normal, result.plane.normal);
      }
    }
}

INSTANTIATE_TEST_SUITE_P(Table, EveryTrace, testing::ValuesIn(cases()), [](const auto& p) {
  return p.param.method + (p.param.solver == Solver::ceres ? "_by_ceres" : "");
});

TEST(Trace, KeepsVisibleSignFromStartAtRest) {
  const Simulation truth = simulate({.motion = Motion::orbit});
  const Initialization result =
      successful(initialize_gpo(truth.window, {.solver = Solver::ceres}, {}));
  EXPECT_EQ(*result.solver.trace.front().normal, -Eigen::Vector3d::UnitZ());
  for (const SolverStep& step : result.solver.trace) EXPECT_LT(step.normal->z(), 0);
}

TEST(Trace, CombinesAllRounds) {
  const Simulation truth =
      simulate_fitted({.motion = Motion::orbit, .gyro_bias_rad_s = 0.002, .row_delay_s = 3e-5});
  for (const MethodOptions& options :
       {MethodOptions{},
        MethodOptions{.time_offset = false},
        MethodOptions{.loss = Loss::huber},
        MethodOptions{.error = ErrorModel::sampson, .shutter = Shutter::global}}) {
    const Initialization result = successful(initialize_gpo_joint(truth.window, options, {}));
    expect_from_initial_to_final_cost(result.solver);
    EXPECT_EQ(*result.solver.trace.back().normal, result.plane.normal);
  }
}

}  // namespace
}  // namespace gpo::test
