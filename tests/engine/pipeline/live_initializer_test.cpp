// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/stop.h"
#include "engine/geometry/pose.h"
#include "engine/initialize.h"
#include "engine/live.h"
#include "tests/engine/pipeline/simulated_frames.h"
#include "tests/engine/test_folder.h"

#include <cmath>
#include <thread>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

struct Simulated {
  Camera camera;
  std::vector<Frame> frames;
};

Simulated simulated(const SimulationOptions& options) {
  const Window window = simulate(options).window;
  return {camera_of(window), frames_of(window)};
}

Simulated moving(std::uint64_t seed, int frames = 24) {
  return simulated(
      {.motion = Motion::orbit, .frames = frames, .points = 80, .travel = 0.2, .seed = seed});
}

/// Returns the first length at which a window alone is ready; 0: none.
int ready_length(const Camera& camera, const std::vector<Frame>& frames) {
  for (std::size_t n = 2; n <= frames.size(); ++n)
    if (initialize(camera, std::span(frames).first(n)).is_ready()) return static_cast<int>(n);
  return 0;
}

LiveStatus fed(const Camera& camera, const std::vector<Frame>& frames, const LiveOptions& options) {
  LiveInitializer initializer(camera, options);
  for (const Frame& frame : frames) initializer.add_frame(frame);
  return initializer.wait();
}

TEST(LiveInitializer, IsReadyAtTheFirstLengthAtWhichAWindowAloneIs) {
  const auto [camera, frames] = moving(5);
  const int expected = ready_length(camera, frames);
  ASSERT_GT(expected, 2);
  for (const bool background : {false, true}) {
    const LiveStatus status = fed(camera, frames, {.background = background});
    EXPECT_EQ(status.ready_frames, expected);
    EXPECT_EQ(status.frames, 24);
    EXPECT_GE(status.solved_frames, expected);
    const LiveStatus first =
        fed(camera, {frames.begin(), frames.begin() + expected}, {.background = background});
    ASSERT_TRUE(first.ready);
    expect_same(first.answer->initialization,
                initialize(camera, std::span(frames).first(expected)).initialization);
  }
}

TEST(LiveInitializer, ReportsLittleMotionWithoutSolving) {
  const auto [camera, frames] = moving(5);
  LiveInitializer initializer(camera, {.background = false});
  LiveStatus status;
  for (int i = 0; i < 3; ++i) status = initializer.add_frame(frames[i]);
  EXPECT_EQ(status.solved_frames, 0);
  EXPECT_THAT(status.reason, testing::HasSubstr("of its distance from the plane, 6 % are needed"));
}

TEST(LiveInitializer, KeepsItsNormalWithinFewSigmasOnceReady) {
  const auto [camera, frames] = moving(9, 30);
  LiveInitializer initializer(camera, {.background = false});
  std::shared_ptr<const WindowResult> first;
  for (const Frame& frame : frames) {
    const LiveStatus status = initializer.add_frame(frame);
    ASSERT_TRUE(status.ready || !first);
    if (!status.ready) continue;
    if (!first) first = status.answer;
    EXPECT_LE(
        angle_deg(first->initialization.plane.normal, status.answer->initialization.plane.normal),
        4 * *first->initialization.verdict->normal_sigma_deg);
  }
  const LiveStatus last = initializer.status();
  EXPECT_GT(last.answer->window.frame_count(), last.ready_frames);  // it improved
}

// From the first ready frame on, every track jumps.
TEST(LiveInitializer, KeepsAnAnswerDespiteContradictingFrames) {
  const auto [camera, frames] = moving(5);
  const int expected = ready_length(camera, frames);
  LiveInitializer initializer(camera, {.background = false});
  LiveStatus status;
  for (int i = 0; i < 24; ++i) {
    Frame frame = frames[i];
    for (int j = 0; i >= expected && j < frame.raw_px.cols(); ++j)
      frame.raw_px.col(j) +=
          Eigen::Vector2d(30 * std::sin(17.0 * i * j), 30 * std::cos(13.0 * i * j));
    status = initializer.add_frame(frame);
  }
  EXPECT_TRUE(status.ready);
  EXPECT_EQ(status.answer->window.frame_count(), expected);
  EXPECT_THAT(status.reason, testing::HasSubstr("frames"));
}

TEST(LiveInitializer, StartsAnewIfTracksEndOrALongWindowIsNotReady) {
  auto [camera, frames] = simulated({.motion = Motion::rotation_only, .frames = 12});
  for (std::size_t i = 6; i < frames.size(); ++i)
    for (std::int64_t& id : frames[i].ids) id += 1000;  // none of the first frame's
  LiveInitializer initializer(camera, {.background = false});
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const LiveStatus status = initializer.add_frame(frames[i]);
    EXPECT_FALSE(status.ready);
    EXPECT_EQ(status.started_anew, i == 6);
    EXPECT_EQ(status.reference, i < 6 ? 0 : 6);
    if (i == 6) {
      EXPECT_EQ(status.reason, "0 of the first frame's 150 tracks are left");
    }
  }
  const auto still = simulated({.motion = Motion::rotation_only, .frames = 12});
  const LiveStatus status =
      fed(still.camera, still.frames, {.background = false, .most_frames = 8});
  EXPECT_EQ(status.reference, 8);
  EXPECT_EQ(status.frames, 4);
}

TEST(LiveInitializer, AcceptsGyroscopeSamplesOverTime) {
  const auto [camera, frames] = moving(5);
  Gyroscope gyroscope;
  LiveInitializer initializer(camera, {.background = false}, Gyroscope{});
  LiveStatus status;
  const std::int64_t period_ns = 5'000'000;
  std::int64_t t_ns = frames[0].timestamp_ns - 2 * period_ns;
  for (std::size_t i = 0; i < frames.size() && !status.ready; ++i) {
    for (; t_ns <= frames[i].timestamp_ns + period_ns; t_ns += period_ns) {
      // Any measurement will do, as both get the same.
      const Eigen::Vector3d rate(0.01 * std::sin(1e-8 * double(t_ns)), 0.02, -0.01);
      gyroscope.timestamps_ns.push_back(t_ns);
      gyroscope.rates_rad_s.push_back(rate);
      initializer.add_gyroscope(t_ns, rate);
    }
    status = initializer.add_frame(frames[i]);
    const auto window = std::span(frames).first(i + 1);
    if (i == 0 || status.solved_frames != static_cast<int>(i) + 1) continue;
    const WindowResult alone = initialize(camera, window, &gyroscope);
    EXPECT_EQ(status.ready, alone.is_ready()) << i;
    if (status.ready) expect_same(status.answer->initialization, alone.initialization);
  }
}

TEST(LiveInitializer, AcceptsAccelerationsForAllSamplesOrNone) {
  const Camera camera = moving(5).camera;
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero(), up(0, -9.81, 0);
  LiveInitializer with(camera), without(camera);
  with.add_imu(1000, zero, up);
  without.add_gyroscope(1000, zero);
  const char* expected = "accelerometer: expected an acceleration with each sample, or with none";
  EXPECT_EQ(error_of([&] { with.add_gyroscope(2000, zero); }), expected);
  EXPECT_EQ(error_of([&] { without.add_imu(2000, zero, up); }), expected);
  EXPECT_EQ(error_of([&] { with.add_imu(2000, zero, up / 0.0); }),
            "accelerometer: an acceleration is not finite");
  with.add_imu(2000, zero, up);
}

TEST(LiveInitializer, GivesTheSameBitsInParallel) {
  struct Run {
    Simulated simulated;
    LiveStatus alone, beside;
  };
  std::vector<Run> runs;
  for (const std::uint64_t seed : {5, 6, 7}) runs.push_back({moving(seed, 16), {}, {}});
  const auto feed = [](const Run& run) {
    return fed(run.simulated.camera, run.simulated.frames, {});
  };
  for (Run& run : runs) run.alone = feed(run);
  {
    std::vector<std::jthread> threads;
    for (Run& run : runs) threads.emplace_back([&] { run.beside = feed(run); });
  }
  for (const Run& run : runs) {
    ASSERT_TRUE(run.alone.ready);
    EXPECT_EQ(run.alone.ready_frames, run.beside.ready_frames);
    EXPECT_EQ(run.alone.solved_frames, run.beside.solved_frames);
    expect_same(run.alone.answer->initialization, run.beside.answer->initialization);
  }
}

TEST(LiveInitializer, CanBeDestroyedWhileSolving) {
  const auto [camera, frames] = moving(5);
  LiveInitializer initializer(camera);
  for (const Frame& frame : frames) initializer.add_frame(frame);
}  // the destructor does not wait for pending windows

TEST(LiveInitializer, StopsWithTheThreadOfItsCaller) {
  const auto [camera, frames] = moving(5);
  std::stop_source source;
  auto method = std::make_shared<Method>(find_method("gpo"));
  method->initialize = [&](const auto&...) {
    source.request_stop();
    check_stop();
    return Initialization{};
  };
  const StopWatch watch{.stop = source.get_token()};
  const StopScope scope(&watch);
  LiveOptions options{.background = false};
  options.initialize.method = MethodChoice(method);
  EXPECT_THROW(fed(camera, frames, options), Stopped);
}

TEST(LiveInitializer, RejectsTheSameInputAsAWindow) {
  const Simulated few = moving(5, 4);
  LiveInitializer initializer(few.camera);
  initializer.add_frame(few.frames[1]);
  EXPECT_THAT(error_of([&] { initializer.add_frame(few.frames[0]); }),
              testing::HasSubstr("frame 1: time stamp"));
  EXPECT_THAT(error_of([&] {
                initializer.add_gyroscope(0, {0, 0, 0}), initializer.add_gyroscope(0, {0, 0, 0});
              }),
              testing::HasSubstr("gyroscope: time stamp 0 does not come after 0"));
  EXPECT_EQ(error_of([] {
              LiveInitializer{{.fx = 1, .fy = 1}, {.most_frames = 1}};
            }),
            "most_frames: 1, expected at least 2");
}

}  // namespace
}  // namespace gpo::test
