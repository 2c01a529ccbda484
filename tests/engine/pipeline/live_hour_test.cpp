// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Memory of LiveInitializer over many windows; tests/nightly.sh simulates an hour.
#include "engine/live.h"
#include "tests/engine/peak_memory.h"
#include "tests/engine/pipeline/simulated_frames.h"

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

/// A short sequence that repeats with new times and new tracks.
struct RepeatedStream {
  Camera camera;
  std::vector<Frame> frames;
  Gyroscope samples;
  std::int64_t period_ns = 0;

  void feed(int repetition, LiveInitializer& initializer) const {
    const std::int64_t shift_ns = repetition * period_ns;
    std::size_t next = 0;
    for (Frame frame : frames) {
      frame.timestamp_ns += shift_ns;
      for (auto& id : frame.ids) id += 1000 * static_cast<std::int64_t>(repetition);
      for (; next < samples.timestamps_ns.size() &&
             samples.timestamps_ns[next] + shift_ns <= frame.timestamp_ns;
           ++next)
        initializer.add_gyroscope(samples.timestamps_ns[next] + shift_ns,
                                  samples.rates_rad_s[next]);
      initializer.add_frame(frame);
    }
  }
};

RepeatedStream repeated_stream() {
  const SimulationOptions options{
      .motion = Motion::orbit, .frames = 30, .points = 40, .gyro_bias_rad_s = 0.01, .seed = 5};
  const Window window = simulate(options).window;
  RepeatedStream stream{camera_of(window), frames_of(window), simulated_gyroscope(options)};
  const auto& times = stream.samples.timestamps_ns;
  stream.period_ns = times.back() - times.front() + 5'000'000;
  return stream;
}

TEST(LiveHour, MemoryStaysFlatAfterTheFirstMinute) {
  const char* requested = std::getenv("GPO_LIVE_FRAMES");
  const int frames = requested != nullptr ? std::atoi(requested) : 3000;
  const int warm_up = std::min(1800, frames / 2);
  constexpr long kMostKiB = 8 << 10;
  const RepeatedStream stream = repeated_stream();
  const int length = static_cast<int>(stream.frames.size());
  Gyroscope without_samples = stream.samples;
  without_samples.timestamps_ns.clear();
  without_samples.rates_rad_s.clear();
  LiveInitializer initializer(stream.camera, {.background = true}, without_samples);
  int repetition = 0;
  for (; repetition * length < warm_up; ++repetition) stream.feed(repetition, initializer);
  const PeakMemory after_first_minute;
  for (; repetition * length < frames; ++repetition) stream.feed(repetition, initializer);
  EXPECT_LT(after_first_minute.kib(), kMostKiB);
  EXPECT_TRUE(initializer.wait().ready);  // frames came faster than windows are solved
}

}  // namespace
}  // namespace gpo::test
