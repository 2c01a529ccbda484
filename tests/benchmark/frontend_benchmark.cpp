// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/inliers.h"
#include "engine/frontend/tracking/tracker.h"
#include "engine/frontend/tracking/tracking.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/recording/recording.h"
#include "tests/benchmark/measure.h"
#include "tests/benchmark/tables.h"

#include <functional>

#include <fmt/format.h>

namespace gpo::bench {
namespace {

constexpr int kFrames = 30;

/// A stage by itself on the bundled recording, 640x480.
struct Stage {
  const char* name;
  void (*run)(benchmark::State& state, const Recording& recording);
};

std::shared_ptr<const Recording> desk(const OpenOptions& options = {}) {
  return open_recording(GPO_SOURCE_DIR "/sequences/desk", options);
}

void decode(benchmark::State& state, const Recording& /*recording*/) {
  const auto recording = desk({.tracks = {}, .cache_bytes = 1});  // keeps one picture
  int frame = 0;
  measure(state, thread_ms, [&] {
    benchmark::DoNotOptimize(recording->images->bgr(frame));
    frame = (frame + 1) % kFrames;
  });
}

void detect(benchmark::State& state, const Recording& recording) {
  const cv::Mat gray = recording.images->gray(0);
  measure(state, thread_ms, [&] { benchmark::DoNotOptimize(detect_corners(gray)); });
  state.counters["tracks"] = static_cast<double>(detect_corners(gray).cols());
}

/// A step from a frame to the next, pictures decoded before: gray, pyramid, tracks.
void track(benchmark::State& state, const Recording& recording, Tracking tracking) {
  TrackerOptions options;
  options.tracking = tracking;
  std::vector<double> ms;
  while (state.KeepRunning()) {
    double begin = 0;
    const auto step = [&](int done, int /*of*/) {
      const double now = thread_ms();
      if (done > 1) ms.push_back(now - begin);
      begin = now;
    };
    track_window([&](int frame) { return recording.images->gray(frame); },
                 recording.camera,
                 {0, kFrames},
                 options,
                 {.progress = step});
  }
  if (!ms.empty()) state.counters["ms"] = median(std::move(ms));
}

void track_frame_to_frame(benchmark::State& state, const Recording& recording) {
  track(state, recording, Tracking::frame_to_frame);
}

void track_anchored(benchmark::State& state, const Recording& recording) {
  track(state, recording, Tracking::anchored);
}

Eigen::Matrix2Xd undistorted(const Camera& camera, const Eigen::Matrix2Xd& raw_px) {
  Eigen::Matrix2Xd result(2, raw_px.cols());
  for (int j = 0; j < raw_px.cols(); ++j) result.col(j) = undistort(camera, raw_px.col(j));
  return result;
}

void undistort_tracks(benchmark::State& state, const Recording& recording) {
  const Eigen::Matrix2Xd corners = detect_corners(recording.images->gray(0));
  measure(
      state, thread_ms, [&] { benchmark::DoNotOptimize(undistorted(recording.camera, corners)); });
}

/// Between the window's first and last frame, where the most tracks are off the plane.
void ransac(benchmark::State& state, const Recording& recording) {
  const auto tracks = track_window(
      [&](int frame) { return recording.images->gray(frame); }, recording.camera, {0, kFrames});
  const Eigen::Matrix2Xd& last = tracks->raw_px.back();
  std::vector<int> seen;
  for (int j = 0; j < last.cols(); ++j) {
    if (last.col(j).allFinite()) seen.push_back(j);
  }
  const Eigen::Matrix2Xd from = undistorted(recording.camera, tracks->raw_px[0](Eigen::all, seen));
  const Eigen::Matrix2Xd to = undistorted(recording.camera, last(Eigen::all, seen));
  measure(state, thread_ms, [&] { benchmark::DoNotOptimize(homography_ransac(from, to, {})); });
}

constexpr Stage kStages[] = {{"decoding a picture", decode},
                             {"detection", detect},
                             {"step, frame to frame", track_frame_to_frame},
                             {"step, anchored", track_anchored},
                             {"undistortion of all tracks", undistort_tracks},
                             {"RANSAC of a pair", ransac}};

}  // namespace

void register_frontend_benchmarks() {
  const auto recording = desk();
  for (const Stage& stage : kStages) {
    benchmark::RegisterBenchmark(
        stage.name, [stage, recording](benchmark::State& state) { stage.run(state, *recording); })
        ->MinTime(0.1)
        ->Repetitions(kRepetitions);
  }
}

void print_frontend_tables(const Results& results) {
  fmt::print("\nFront end, 640x480, {} tracks:\n\n",
             whole_number(results.least("detection", "tracks")));
  print_head({"stage", "time [ms]"});
  for (const Stage& stage : kStages) print_row({stage.name, cell(results.least(stage.name, "ms"))});
}

}  // namespace gpo::bench
