// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initialize.h"
#include "engine/inspection/inspector.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/benchmark/measure.h"
#include "tests/benchmark/tables.h"

#include <algorithm>
#include <memory>
#include <numeric>

#include <fmt/format.h>

namespace gpo::bench {
namespace {

constexpr int kFrames = 60;

/// The bundled recording's tracks as a front end hands them over, frame by frame.
struct Stream {
  std::shared_ptr<const Recording> recording;
  std::vector<Frame> frames;
};

Stream desk_stream() {
  Stream stream{open_recording(GPO_SOURCE_DIR "/sequences/desk"), {}};
  Settings settings;
  settings.frames = kFrames;
  const Tracks tracks = *Inspector(stream.recording).inspect(settings)->tracks;
  for (int i = 0; i < kFrames; ++i) {
    std::vector<int> seen;
    for (int j = 0; j < tracks.track_count(); ++j)
      if (tracks.seen(i, j)) seen.push_back(j);
    Frame frame{.timestamp_ns = stream.recording->timestamps_ns[i],
                .raw_px = tracks.raw_px[i](Eigen::all, seen)};
    for (const int j : seen) frame.ids.push_back(tracks.ids[j]);
    stream.frames.push_back(std::move(frame));
  }
  return stream;
}

/// The calling thread's time in `add_frame`: mean and worst over the frames.
void add_frames(benchmark::State& state, const Stream& stream, bool background) {
  std::vector<double> means, worsts;
  while (state.KeepRunning()) {
    LiveInitializer initializer(
        stream.recording->camera, {.background = background}, stream.recording->gyroscope);
    std::vector<double> ms;
    for (const Frame& frame : stream.frames) {
      const double begin = thread_ms();
      initializer.add_frame(frame);
      ms.push_back(thread_ms() - begin);
    }
    initializer.wait();
    means.push_back(std::accumulate(ms.begin(), ms.end(), 0.0) / kFrames);
    worsts.push_back(std::ranges::max(ms));
  }
  if (means.empty()) return;
  state.counters["mean"] = median(std::move(means));
  state.counters["worst"] = median(std::move(worsts));
  state.counters["tracks"] = static_cast<double>(stream.frames[0].ids.size());
}

struct Mode {
  const char* name;
  bool background;
};
constexpr Mode kModes[] = {{"windows solved on a thread of their own", true},
                           {"windows solved in the call", false}};

}  // namespace

void register_live_benchmarks() {
  const auto stream = std::make_shared<Stream>(desk_stream());
  for (const Mode& mode : kModes) {
    benchmark::RegisterBenchmark(
        mode.name,
        [stream, mode](benchmark::State& state) { add_frames(state, *stream, mode.background); })
        ->MinTime(0.1)
        ->Repetitions(kRepetitions);
  }
}

void print_live_tables(const Results& results) {
  fmt::print(
      "\n`LiveInitializer::add_frame`, {} frames of {} tracks, the calling thread's time [ms]:\n\n",
      kFrames,
      whole_number(results.least(kModes[0].name, "tracks")));
  print_head({"", "mean", "worst frame"});
  for (const Mode& mode : kModes)
    print_row({mode.name,
               cell(results.least(mode.name, "mean")),
               cell(results.least(mode.name, "worst"))});
}

}  // namespace gpo::bench
