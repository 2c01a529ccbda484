// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Stages of the engine by themselves: front end, planes of a room, gravity, live initialization and
// whole experiments. Most use the bundled recording, 640x480.
#include "engine/diagnosis/diagnosis.h"
#include "engine/experiment/runner.h"
#include "engine/inertial/inertial_alignment.h"
#include "engine/initialize.h"
#include "engine/inspection/inspector.h"
#include "engine/live.h"
#include "engine/methods/initializers.h"
#include "engine/methods/methods.h"
#include "engine/planes/inliers.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/recording/recording.h"
#include "engine/tracking/tracker.h"
#include "engine/tracking/tracking.h"
#include "tests/benchmark/benchmarks.h"
#include "tests/engine/inertial/simulated_motion.h"
#include "tests/engine/simulated_room.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <opencv2/video/tracking.hpp>
#include <unistd.h>

namespace gpo::bench {
namespace {

using benchmark::State;

constexpr int kTracked = 30, kLive = 60;  // frames
constexpr int kSeconds[] = {1, 2, 4};
constexpr int kJobs[] = {1, 2};

std::shared_ptr<const Recording> desk(const OpenOptions& options = {}) {
  return open_recording(GPO_SOURCE_DIR "/sequences/desk", options);
}

void decode(State& state, const Recording& /*recording*/) {
  const auto recording = desk({.tracks = {}, .cache_bytes = 1});  // caches one image
  int frame = 0;
  measure(state, thread_ms, [&] {
    benchmark::DoNotOptimize(recording->images->bgr(frame));
    frame = (frame + 1) % kTracked;
  });
}

void detect(State& state, const Recording& recording) {
  const cv::Mat gray = recording.images->gray(0);
  measure(state, thread_ms, [&] { benchmark::DoNotOptimize(detect_corners(gray)); });
  state.counters["tracks"] = static_cast<double>(detect_corners(gray).cols());
}

std::vector<cv::Mat> gray_images(const Recording& recording) {
  std::vector<cv::Mat> all;
  for (int i = 0; i < kTracked; ++i) all.push_back(recording.images->gray(i));
  return all;
}

/// A step from one gray image to the next: pyramid, tracks.
template <Tracking kTracking>
void track(State& state, const Recording& recording) {
  const std::vector<cv::Mat> gray = gray_images(recording);
  std::vector<double> ms;
  while (state.KeepRunning()) {
    double begin = 0;
    const auto step = [&](int done, int /*of*/) {
      const double now = thread_ms();
      if (done > 1) ms.push_back(now - begin);
      begin = now;
    };
    track_window([&](int frame) { return gray[frame]; },
                 recording.camera,
                 {0, kTracked},
                 kTracking,
                 {.progress = step});
  }
  if (!ms.empty()) state.counters["ms"] = median(std::move(ms));
}

/// OpenCV's flow of the same points there and back with its defaults, 21x21 and 3 levels; each
/// image's pyramid is built once.
void opencv_flow(State& state, const Recording& recording) {
  const cv::Size window(21, 21);
  constexpr int kLevels = 3;
  const std::vector<cv::Mat> gray = gray_images(recording);
  const auto tracks = *track_window(
      [&](int frame) { return gray[frame]; }, recording.camera, {0, kTracked}, Tracking::anchored);
  std::vector<double> ms;
  while (state.KeepRunning()) {
    std::vector<cv::Mat> from, to;
    for (int i = 0; i < kTracked; ++i) {
      std::vector<cv::Point2f> points, there, back;
      for (int j = 0; i > 0 && j < tracks.track_count(); ++j)
        if (tracks.seen(i - 1, j))
          points.emplace_back(cv::Point2d(tracks.raw_px[i - 1](0, j), tracks.raw_px[i - 1](1, j)));
      std::vector<unsigned char> found;
      const double begin = thread_ms();
      cv::buildOpticalFlowPyramid(gray[i], to, window, kLevels);
      if (i > 0) {
        cv::calcOpticalFlowPyrLK(from, to, points, there, found, cv::noArray(), window, kLevels);
        cv::calcOpticalFlowPyrLK(to, from, there, back, found, cv::noArray(), window, kLevels);
        ms.push_back(thread_ms() - begin);
      }
      std::swap(from, to);
    }
  }
  if (!ms.empty()) state.counters["ms"] = median(std::move(ms));
}

Eigen::Matrix2Xd undistorted(const Camera& camera, const Eigen::Matrix2Xd& raw_px) {
  Eigen::Matrix2Xd result(2, raw_px.cols());
  for (int j = 0; j < raw_px.cols(); ++j) result.col(j) = undistort(camera, raw_px.col(j));
  return result;
}

void undistort_tracks(State& state, const Recording& recording) {
  const Eigen::Matrix2Xd corners = detect_corners(recording.images->gray(0));
  measure(
      state, thread_ms, [&] { benchmark::DoNotOptimize(undistorted(recording.camera, corners)); });
}

/// Between the window's first and last frame, which have most tracks off the plane.
void ransac(State& state, const Recording& recording) {
  const auto tracks = track_window(
      [&](int frame) { return recording.images->gray(frame); }, recording.camera, {0, kTracked});
  const Eigen::Matrix2Xd& last = tracks->raw_px.back();
  std::vector<int> seen;
  for (int j = 0; j < last.cols(); ++j)
    if (last.col(j).allFinite()) seen.push_back(j);
  const Eigen::Matrix2Xd from = undistorted(recording.camera, tracks->raw_px[0](Eigen::all, seen));
  const Eigen::Matrix2Xd to = undistorted(recording.camera, last(Eigen::all, seen));
  measure(state, thread_ms, [&] { benchmark::DoNotOptimize(homography_ransac(from, to, {})); });
}

struct Stage {
  const char* name;
  void (*run)(State& state, const Recording& recording);
};
constexpr const char* kAnchored = "step, anchored";
constexpr const char* kOpenCv = "OpenCV's flow, forward and backward";
constexpr Stage kFrontEnd[] = {{"decoding an image", decode},
                               {"detection", detect},
                               {"step, frame to frame", track<Tracking::frame_to_frame>},
                               {kAnchored, track<Tracking::anchored>},
                               {kOpenCv, opencv_flow},
                               {"undistortion of all tracks", undistort_tracks},
                               {"RANSAC of a pair", ransac}};

struct Room {
  const char* name;
  int planes;
  RotationModel rotations;
};
constexpr Room kRooms[] = {{"one plane, rotations known", 1, RotationModel::known},
                           {"three planes, rotations known", 3, RotationModel::known},
                           {"one plane, rotations free", 1, RotationModel::free},
                           {"three planes, rotations free", 3, RotationModel::free}};

/// 30 frames, 200 tracks, 0.2 px noise.
Window window_of(const Room& room) {
  test::RoomOptions options{.frames = 30, .planes = test::floor_and_walls()};
  options.planes.resize(room.planes);
  options.shares.assign(room.planes, 1.0 / room.planes);
  Window window = test::simulate_room(options).window;
  window.rotations = room.rotations;
  return window;
}

void solve(State& state, const Room& room) {
  const Window window = window_of(room);
  Initialization result;
  measure(state, thread_ms, [&] { result = initialize_gpo_joint(window, {}, {}); });
  if (!result.ok) state.SkipWithError(result.reason.c_str());
  state.counters["planes"] = static_cast<double>(result.planes.size());
}

/// A window's answer once it has rotations: planes, `gpo_joint`, uncertainty, verdict.
struct Answer {
  const char* name;
  double reference_noise_px;
  RotationModel rotations;
};
constexpr Answer kAnswers[] = {{"anchored tracks, gyroscope", 0, RotationModel::bias},
                               {"anchored tracks, images only", 0, RotationModel::free},
                               {"other tracks, gyroscope", 0.5, RotationModel::bias},
                               {"other tracks, images only", 0.5, RotationModel::free}};

/// 30 frames, 200 tracks, 0.5 px noise.
void answer(State& state, const Answer& of) {
  test::SimulationOptions options{.motion = test::Motion::orbit, .points = 200};
  options.reference_noise_px = of.reference_noise_px;
  if (of.rotations == RotationModel::bias)
    options.gyro_bias_rad_s = options.gyro_noise_rad_s = 0.002;
  const test::Simulation simulation = test::simulate(options);
  const Method& method = find_method("gpo_joint");
  Initialization result;
  measure(state, thread_ms, [&] {
    Window window = test::window_by_front_end(simulation, Inliers::planes);
    window.rotations = of.rotations;
    window.gyro = simulation.window.gyro;
    result = assessed(method, window, method.initialize(window, {}, {}), Lens::typical);
  });
  if (!result.ok) state.SkipWithError(result.reason.c_str());
  state.counters["iterations"] = result.solver.iterations;
}

void extract(State& state, const Room& room) {
  const Window window = window_of(room);
  measure(state, thread_ms, [&] { benchmark::DoNotOptimize(window_planes(window.points_px)); });
}

void align(State& state, int seconds) {
  const SimulatedAlignment made = simulated_alignment(Pace::brisk, kPhone, seconds, 1);
  InertialAlignment result;
  measure(state, thread_ms, [&] {
    result = align_inertial(made.poses, made.gyroscope, made.T_body_camera, made.options);
  });
  if (!result.ok) state.SkipWithError(result.reason.c_str());
  state.counters["frames"] = static_cast<double>(made.poses.cameras.size());
}

/// The bundled recording's tracks, frame by frame as from a front end.
struct Stream {
  std::shared_ptr<const Recording> recording;
  std::vector<Frame> frames;
};

Stream desk_stream() {
  Stream stream{desk(), {}};
  const Tracks tracks = *Inspector(stream.recording).inspect({.frames = kLive})->tracks;
  for (int i = 0; i < kLive; ++i) {
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

/// Measures the calling thread's time in `add_frame`: mean and maximum over the frames.
void add_frames(State& state, const Stream& stream, bool background) {
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
    means.push_back(std::accumulate(ms.begin(), ms.end(), 0.0) / kLive);
    worsts.push_back(std::ranges::max(ms));
  }
  if (means.empty()) return;
  state.counters["mean"] = median(std::move(means));
  state.counters["worst"] = median(std::move(worsts));
  state.counters["tracks"] = static_cast<double>(stream.frames[0].ids.size());
}

constexpr std::pair<const char*, bool> kLiveModes[] = {
    {"windows solved on a thread of their own", true}, {"windows solved in the call", false}};

/// Runs an experiment from the start, including the decoding of all images.
void evaluate(State& state, int jobs) {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::temp_directory_path() / fmt::format("gpo-evaluate-benchmark-{}", getpid());
  int windows = 0;
  measure(state, wall_ms, [&] {
    fs::remove_all(folder);
    const std::vector<std::shared_ptr<const Recording>> recordings{desk()};
    ExperimentRequest request{
        {}, parse_ranges("10:30:20", "lengths"), parse_ranges("0:15:5", "starts"), 1};
    for (const Method& method : methods()) request.configurations.push_back({method.key});
    const Experiment experiment = plan_experiment(recordings, request);
    windows = window_count(tasks_of(experiment));
    run_experiment(experiment, recordings, folder, {.jobs = jobs});
  });
  fs::remove_all(folder);
  state.counters["windows"] = windows;
}

std::string solving(const Room& room) { return fmt::format("gpo_joint, {}", room.name); }
std::string answering(const Answer& of) { return fmt::format("answer, {}", of.name); }
std::string extracting(const Room& room) { return fmt::format("extraction, {}", room.name); }
std::string aligning(int seconds) { return fmt::format("alignment, {} s", seconds); }
std::string evaluating(int jobs) { return fmt::format("evaluate/{}", jobs); }

}  // namespace

void register_stage_benchmarks() {
  const auto recording = desk();
  for (const Stage& stage : kFrontEnd)
    add(stage.name, [stage, recording](State& state) { stage.run(state, *recording); });
  for (const Room& room : kRooms) {
    add(solving(room), [room](State& state) { solve(state, room); });
    add(extracting(room), [room](State& state) { extract(state, room); });
  }
  for (const Answer& of : kAnswers) add(answering(of), [of](State& state) { answer(state, of); });
  for (const int seconds : kSeconds)
    add(aligning(seconds), [seconds](State& state) { align(state, seconds); });
  const auto stream = std::make_shared<Stream>(desk_stream());
  for (const auto& [name, background] : kLiveModes)
    add(name, [stream, background = background](State& state) {
      add_frames(state, *stream, background);
    });
  for (const int jobs : kJobs)
    benchmark::RegisterBenchmark(evaluating(jobs).c_str(),
                                 [jobs](State& state) { evaluate(state, jobs); })
        ->UseRealTime()
        ->Iterations(1)
        ->Repetitions(kRepetitions);
}

void print_stage_tables(const Results& results) {
  fmt::print("\nFront end, 640x480, {} tracks:\n\n",
             whole_number(results.least("detection", "tracks")));
  print_head("stage | time [ms]");
  for (const Stage& stage : kFrontEnd) print_row({stage.name, cell(results.ms(stage.name))});

  fmt::print("\nAn anchored step takes {} times as long as OpenCV's flow.\n",
             cell(ratio(results.ms(kAnchored), results.ms(kOpenCv))));

  fmt::print("\nPlanes of a room, 30 frames, 200 tracks:\n\n");
  print_head("window | planes | extraction [ms] | `gpo_joint` [ms]");
  for (const Room& room : kRooms)
    print_row({room.name,
               whole_number(results.least(solving(room), "planes")),
               cell(results.ms(extracting(room))),
               cell(results.ms(solving(room)))});

  fmt::print("\nThe default answer, 30 frames, 200 tracks:\n\n");
  print_head("window | iterations | planes, `gpo_joint`, uncertainty, verdict [ms]");
  for (const Answer& of : kAnswers)
    print_row({of.name,
               whole_number(results.least(answering(of), "iterations")),
               cell(results.ms(answering(of)))});

  fmt::print("\nGravity and metric scale, 10 samples per frame:\n\n");
  print_head("frames | alignment [ms]");
  for (const int seconds : kSeconds)
    print_row({whole_number(results.least(aligning(seconds), "frames")),
               cell(results.ms(aligning(seconds)))});

  fmt::print(
      "\n`LiveInitializer::add_frame`, {} frames of {} tracks, the calling thread's time [ms]:\n\n",
      kLive,
      whole_number(results.least(kLiveModes[0].first, "tracks")));
  print_head(" | mean | worst frame");
  for (const auto& [name, background] : kLiveModes)
    print_row({name, cell(results.least(name, "mean")), cell(results.least(name, "worst"))});

  fmt::print("\n`evaluate` on `sequences/desk`, {} windows of 10 and 30 frames by {} methods:\n\n",
             whole_number(results.least(evaluating(1), "windows")),
             methods().size());
  print_head("`--jobs` | windows/s");
  for (const int jobs : kJobs) {
    const auto per_ms =
        ratio(results.least(evaluating(jobs), "windows"), results.ms(evaluating(jobs)));
    print_row({std::to_string(jobs), cell(ratio(per_ms, 1e-3))});
  }
}

}  // namespace gpo::bench
