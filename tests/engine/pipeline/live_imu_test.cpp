// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// LiveInitializer with samples that are late, missing, or added by other threads.
#include "engine/initialize.h"
#include "engine/live.h"
#include "engine/pipeline/live_samples.h"
#include "tests/engine/pipeline/simulated_frames.h"
#include "tests/engine/test_folder.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr std::int64_t kMillisecond_ns = 1'000'000;

/// Frames at 30 Hz and samples at 200 Hz of a camera that moves.
struct ImuStream {
  Camera camera;
  std::vector<Frame> frames;
  Gyroscope gyroscope;  ///< without samples
  Gyroscope samples;
};

ImuStream stream_of(int frames) {
  const SimulationOptions options{.motion = Motion::orbit,
                                  .frames = frames,
                                  .points = 80,
                                  .travel = 0.008 * frames,
                                  .gyro_bias_rad_s = 0.01,
                                  .seed = 5};
  const Window window = simulate(options).window;
  ImuStream stream{camera_of(window), frames_of(window), {}, simulated_gyroscope(options)};
  stream.gyroscope = stream.samples;
  stream.gyroscope.timestamps_ns.clear();
  stream.gyroscope.rates_rad_s.clear();
  return stream;
}

void add_sample(const Gyroscope& samples, std::size_t k, LiveInitializer& initializer) {
  initializer.add_gyroscope(samples.timestamps_ns[k], samples.rates_rad_s[k]);
}

/// Removes the samples of a time span, counted from the first frame.
void cut_samples(ImuStream& stream, double from_s, double to_s) {
  Gyroscope left = stream.gyroscope;
  for (std::size_t k = 0; k < stream.samples.timestamps_ns.size(); ++k) {
    const std::int64_t t_ns = stream.samples.timestamps_ns[k];
    const double s = 1e-9 * static_cast<double>(t_ns - stream.frames[0].timestamp_ns);
    if (s >= from_s && s < to_s) continue;
    left.timestamps_ns.push_back(t_ns);
    left.rates_rad_s.push_back(stream.samples.rates_rad_s[k]);
  }
  stream.samples = left;
}

/// Returns the status after each frame; samples come `late_ns` after their time.
std::vector<LiveStatus> fed_live(const ImuStream& stream,
                                 std::int64_t late_ns,
                                 LiveInitializer& initializer) {
  std::vector<LiveStatus> statuses;
  std::size_t next = 0;
  for (const Frame& frame : stream.frames) {
    const auto& t = stream.samples.timestamps_ns;
    for (; next < t.size() && t[next] + late_ns <= frame.timestamp_ns; ++next)
      add_sample(stream.samples, next, initializer);
    statuses.push_back(initializer.add_frame(frame));
  }
  for (; next < stream.samples.timestamps_ns.size(); ++next)
    add_sample(stream.samples, next, initializer);
  return statuses;
}

std::vector<LiveStatus> fed_in_turn(const ImuStream& stream, std::int64_t late_ns = 0) {
  LiveInitializer initializer(stream.camera, {.background = false}, stream.gyroscope);
  return fed_live(stream, late_ns, initializer);
}

std::vector<std::string> reasons_of(const std::vector<LiveStatus>& statuses) {
  std::vector<std::string> reasons;
  for (const LiveStatus& status : statuses) reasons.push_back(status.reason);
  return reasons;
}

/// Returns the index of the first status that is ready.
int ready_call(const std::vector<LiveStatus>& statuses) {
  return static_cast<int>(std::ranges::find(statuses, true, &LiveStatus::ready) - statuses.begin());
}

TEST(LiveInitializerSamples, DelayReadinessByAtMostTheirOwnDelay) {
  const ImuStream stream = stream_of(24);
  const int in_time = ready_call(fed_in_turn(stream));
  ASSERT_LT(in_time, 20);
  for (const auto& [late_ms, frames] : {std::pair(8, 1), {20, 1}, {50, 2}}) {
    SCOPED_TRACE(late_ms);
    const auto statuses = fed_in_turn(stream, late_ms * kMillisecond_ns);
    const int late = ready_call(statuses);
    ASSERT_LE(late, in_time + frames);
    EXPECT_EQ(statuses[late].waiting, frames);
    const int length = statuses[late].ready_frames;
    EXPECT_EQ(length, in_time + 1);
    const WindowResult alone =
        initialize(stream.camera, std::span(stream.frames).first(length), &stream.samples);
    expect_same(statuses[late].answer->initialization, alone.initialization);
    EXPECT_EQ(statuses[late].answer->rotations, RotationSource::gyro_calibrated);
  }
}

TEST(LiveInitializerSamples, GiveTheSameAnswerInTheBackgroundAfterWaiting) {
  const ImuStream stream = stream_of(40);
  for (const int late_ms : {0, 20, 50}) {
    SCOPED_TRACE(late_ms);
    std::vector<LiveStatus> ends;
    for (const bool background : {false, true}) {
      LiveInitializer initializer(stream.camera, {.background = background}, stream.gyroscope);
      fed_live(stream, late_ms * kMillisecond_ns, initializer);
      ends.push_back(initializer.wait());
      EXPECT_EQ(ends.back().pending + ends.back().waiting, 0);
      EXPECT_EQ(ends.back().frames, 40);
    }
    ASSERT_TRUE(ends[0].ready && ends[1].ready);
    EXPECT_EQ(ends[0].ready_frames, ends[1].ready_frames);
    EXPECT_EQ(ends[0].solved_frames, ends[1].solved_frames);
    expect_same(ends[0].answer->initialization, ends[1].answer->initialization);
  }
}

TEST(LiveInitializerSamples, StartANewWindowAfterAGap) {
  ImuStream stream = stream_of(60);
  cut_samples(stream, 0.05, 0.3);
  const auto statuses = fed_in_turn(stream, 8 * kMillisecond_ns);
  EXPECT_THAT(reasons_of(statuses), Contains(HasSubstr("gap of 0.25")));
  const LiveStatus& last = statuses.back();
  ASSERT_TRUE(last.ready) << last.reason;
  EXPECT_EQ(last.reference, 9);  // the first frame after the gap
  EXPECT_EQ(last.answer->rotations, RotationSource::gyro_calibrated);
}

TEST(LiveInitializerSamples, KeepTheAnswerIfAGapFollows) {
  ImuStream stream = stream_of(60);
  cut_samples(stream, 0.9, 1.2);
  const auto statuses = fed_in_turn(stream);
  ASSERT_LT(ready_call(statuses), 27);
  const LiveStatus& last = statuses.back();
  EXPECT_TRUE(last.ready);
  EXPECT_EQ(last.reference, 0);
  EXPECT_LT(last.frames, 29);
  EXPECT_THAT(last.reason, HasSubstr("its answer is final: "));
  EXPECT_THAT(last.reason, HasSubstr("gap of 0.3"));
}

TEST(LiveInitializerSamples, LeaveTheRotationsToTheImagesIfThereAreNone) {
  ImuStream stream = stream_of(24);
  stream.samples = stream.gyroscope;
  const auto statuses = fed_in_turn(stream);
  const int ready = ready_call(statuses);
  ASSERT_LT(ready, 24);
  const auto window = std::span(stream.frames).first(ready + 1);
  expect_same(statuses[ready].answer->initialization,
              initialize(stream.camera, window).initialization);
  EXPECT_THAT(statuses[ready].answer->rotations_note,
              HasSubstr("the gyroscope has no samples in this window"));
  LiveInitializer only_gyroscope(
      stream.camera,
      {.initialize = {.rotations = RotationSource::gyro}, .background = false},
      stream.gyroscope);
  EXPECT_EQ(fed_live(stream, 0, only_gyroscope).back().reason,
            "rotations: gyro: no gyroscope given");
}

TEST(LiveInitializerSamples, LeaveTheRotationsToTheImagesHalfASecondAfterTheLast) {
  ImuStream stream = stream_of(80);
  cut_samples(stream, 0.1, 100);
  const auto statuses = fed_in_turn(stream);
  EXPECT_EQ(std::ranges::max(statuses, {}, &LiveStatus::waiting).waiting, 14);
  EXPECT_TRUE(statuses[18].started_anew);
  ASSERT_TRUE(statuses.back().ready) << statuses.back().reason;
  EXPECT_GT(statuses.back().reference, 2);
  EXPECT_NE(statuses.back().answer->rotations, RotationSource::gyro_calibrated);
}

TEST(LiveInitializerSamples, AreBoundedInNumber) {
  LiveSamples samples(std::nullopt);
  for (std::int64_t k = 0; k < 100'000; ++k)
    samples.add(10 * k * kMillisecond_ns, Eigen::Vector3d::Zero(), nullptr);
  const std::int64_t last_ns = samples.newest_ns();
  EXPECT_EQ(samples.of_window(0, last_ns, last_ns)->timestamps_ns.size(), 60'001U);
  samples.drop_before(last_ns);
  EXPECT_EQ(samples.of_window(0, last_ns, last_ns)->timestamps_ns.size(), 101U);
  samples.close();
  samples.add(last_ns + 1, Eigen::Vector3d::Zero(), nullptr);
  EXPECT_EQ(samples.newest_ns(), last_ns + 1);
  EXPECT_EQ(samples.of_window(0, last_ns + 1, last_ns + 1)->timestamps_ns.size(), 101U);
}

TEST(LiveInitializer, IsUnchangedByCallsThatThrow) {
  const ImuStream stream = stream_of(16);
  LiveInitializer clean(stream.camera, {.background = false}, stream.gyroscope);
  LiveInitializer tried(stream.camera, {.background = false}, stream.gyroscope);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  std::size_t next = 0;
  LiveStatus expected, status;
  for (const Frame& frame : stream.frames) {
    for (; stream.samples.timestamps_ns[next] <= frame.timestamp_ns; ++next) {
      add_sample(stream.samples, next, clean);
      EXPECT_THROW(tried.add_gyroscope(stream.samples.timestamps_ns[next], {kNan, 0, 0}),
                   InputError);
      add_sample(stream.samples, next, tried);
      EXPECT_THROW(add_sample(stream.samples, next, tried), InputError);
    }
    for (int fault = 0; fault < 5; ++fault) {
      Frame bad = frame;
      if (fault == 0) bad.timestamp_ns = 0;
      if (fault == 1) bad.ids[1] = bad.ids[0];
      if (fault == 2) bad.raw_px(1, 2) = kNan;
      if (fault == 3) bad.ids.pop_back();
      if (fault == 4) bad.timestamp_ns = std::numeric_limits<std::int64_t>::max();
      if (fault > 0 || status.frames > 0) {
        EXPECT_THROW(tried.add_frame(bad), InputError) << fault;
      }
    }
    EXPECT_EQ(tried.status().frames, status.frames);
    expected = clean.add_frame(frame);
    status = tried.add_frame(frame);
  }
  ASSERT_TRUE(status.ready);
  EXPECT_EQ(status.ready_frames, expected.ready_frames);
  expect_same(status.answer->initialization, expected.answer->initialization);
}

TEST(LiveInitializer, ReportsTheErrorOfAMethodAsReason) {
  const ImuStream stream = stream_of(16);
  auto own = std::make_shared<Method>(find_method("pnp"));
  own->key = "mine";
  own->initialize = [](const auto&, const auto&, const auto&) -> Initialization {
    throw std::runtime_error("out of order");
  };
  for (const bool background : {false, true}) {
    LiveInitializer initializer(
        stream.camera, {.initialize = {.method = MethodChoice(own)}, .background = background});
    for (const Frame& frame : stream.frames) EXPECT_NO_THROW(initializer.add_frame(frame));
    const LiveStatus status = initializer.wait();
    EXPECT_EQ(status.frames, 16);
    EXPECT_THAT(status.reason, HasSubstr("out of order"));
  }
  EXPECT_EQ(error_of([&] {
              own->initialize = nullptr;
              LiveInitializer(stream.camera, {.initialize = {.method = MethodChoice(own)}});
            }),
            "method: mine has no function");
}

TEST(LiveInitializer, StartsAnewAtAFrameWithoutTracksAlsoInTheBackground) {
  ImuStream stream = stream_of(30);
  stream.frames[4].ids.clear();
  stream.frames[4].raw_px.resize(2, 0);
  std::vector<LiveStatus> ends;
  for (const bool background : {false, true}) {
    LiveInitializer initializer(stream.camera, {.background = background, .least_tracks = 0});
    for (const Frame& frame : stream.frames) initializer.add_frame(frame);
    ends.push_back(initializer.wait());
    EXPECT_EQ(ends.back().reference, 5);
    EXPECT_EQ(ends.back().frames, 25);
  }
  ASSERT_TRUE(ends[0].ready);
  expect_same(ends[0].answer->initialization, ends[1].answer->initialization);
}

// No window is ever ready, because the camera is a guess.
TEST(LiveInitializer, IsBoundedOverManyWindows) {
  const ImuStream stream = stream_of(40);
  LiveInitializer initializer(stream.camera,
                              {.initialize = {.camera_is_guess = true}, .most_frames = 10});
  std::int64_t t_ns = 0;
  int restarts = 0;
  for (int i = 0; i < 3000; ++i) {
    Frame frame = stream.frames[i % 40];
    frame.timestamp_ns = (t_ns += 33 * kMillisecond_ns);
    for (int k = 0; k < 6; ++k)
      initializer.add_gyroscope(t_ns + 5 * k * kMillisecond_ns, Eigen::Vector3d::Zero());
    const LiveStatus status = initializer.add_frame(frame);
    ASSERT_LE(status.pending, 2);
    ASSERT_LE(status.waiting, 11);
    ASSERT_LE(status.frames, 10);
    restarts += status.started_anew ? 1 : 0;
  }
  EXPECT_GE(restarts, 100);
  EXPECT_FALSE(initializer.wait().ready);
}

TEST(LiveInitializer, AcceptsSamplesAndQuestionsFromOtherThreads) {
  const ImuStream stream = stream_of(24);
  for (const bool background : {false, true}) {
    LiveInitializer initializer(stream.camera, {.background = background}, stream.gyroscope);
    std::atomic<bool> done = false;
    {
      const std::jthread imu([&] {
        for (std::size_t k = 0; k < stream.samples.timestamps_ns.size(); ++k)
          add_sample(stream.samples, k, initializer);
      });
      const std::jthread screen([&] {
        while (!done) initializer.status();
      });
      for (const Frame& frame : stream.frames) initializer.add_frame(frame);
      done = true;
    }
    const LiveStatus status = initializer.wait();
    EXPECT_EQ(status.waiting, 0);
    EXPECT_GT(status.frames, 0);
  }
}

}  // namespace
}  // namespace gpo::test
