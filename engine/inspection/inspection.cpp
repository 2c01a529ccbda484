// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspection.h"

#include "engine/base/error.h"
#include "engine/frontend/homography_ransac.h"
#include "engine/frontend/make_window.h"
#include "engine/frontend/tracker.h"
#include "engine/frontend/tracking.h"
#include "engine/initializers/certainty/growth.h"
#include "engine/initializers/methods.h"
#include "engine/inspection/window_rotations.h"
#include "engine/recording/board/board_corners.h"
#include "engine/recording/board/board_pose.h"
#include "engine/recording/board/board_truth.h"
#include "engine/window/tracks.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <tuple>

#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// A stage's last result, kept until its inputs change.
template <class Key, class Value>
struct Kept {
  std::optional<Key> key;
  Value value{};
  double milliseconds = 0;

  /// Recomputes where `wanted` differs; `compute` returns nothing where it was stopped.
  template <class Compute>
  bool update(const Key& wanted, Compute&& compute) {
    if (key == wanted) return true;
    key.reset();
    const auto begin = Clock::now();
    auto computed = compute();
    if (!computed) return false;
    value = std::move(*computed);
    milliseconds = milliseconds_since(begin);
    key = wanted;
    return true;
  }
};

using Span = std::tuple<int, int>;  // start, frames
using TrackedSpan = std::tuple<Span, Tracking>;
using Excluded = std::vector<std::int64_t>;
using Rejected = std::tuple<TrackedSpan, Excluded, RansacOptions, Inliers>;

/// What is kept where it begins at the same frame and is long enough, else what is wanted.
Span covering(const std::optional<Span>& kept, const Span& wanted) {
  const auto [start, frames] = wanted;
  const bool covers = kept && std::get<0>(*kept) == start && std::get<1>(*kept) >= frames;
  return covers ? *kept : wanted;
}

/// Tracks are made frame by frame, so that those of a shorter window are the beginning of these.
struct Tracked {
  std::shared_ptr<const Tracks> tracks;
  std::vector<double> milliseconds;  ///< one a frame: when it was done
};

Tracked chosen_tracks(const Recording& recording, int start, int frames) {
  const auto begin = Clock::now();
  Tracks tracks = select_tracks(recording.tracks, start, frames);
  return {std::make_shared<const Tracks>(std::move(tracks)),
          std::vector<double>(frames, milliseconds_since(begin))};
}

std::optional<Tracked> followed_tracks(const Recording& recording,
                                       int start,
                                       int frames,
                                       Tracking tracking,
                                       const std::stop_token& stop,
                                       const Progress& progress) {
  if (!recording.pictures) {
    throw InputError(
        fmt::format("{}: no pictures and no tracks; expected --tracks FILE", recording.name));
  }
  Tracked tracked;
  const auto begin = Clock::now();
  const auto told = [&](int done, int of) {
    tracked.milliseconds.push_back(milliseconds_since(begin));
    if (progress) progress("tracking", done, of);
  };
  const TrackerOptions options{.tracking = tracking};
  auto tracks = track_window([&](int frame) { return recording.pictures->gray(frame); },
                             recording.camera,
                             start,
                             frames,
                             options,
                             stop,
                             told);
  if (!tracks) return std::nullopt;
  tracked.tracks = std::make_shared<const Tracks>(std::move(*tracks));
  return tracked;
}

std::shared_ptr<const Tracks> beginning(const std::shared_ptr<const Tracks>& whole, int frames) {
  if (whole->frame_count() == frames) return whole;
  Tracks tracks = *whole;
  tracks.raw_px.resize(frames);
  if (!tracks.forward_backward_px.empty()) tracks.forward_backward_px.resize(frames);
  for (std::optional<TrackEnd>& end : tracks.ends) {
    if (end && end->frame >= frames) end.reset();
  }
  return std::make_shared<const Tracks>(std::move(tracks));
}

std::shared_ptr<const WindowTruth> beginning(const std::shared_ptr<const WindowTruth>& whole,
                                             int frames) {
  if (!whole || static_cast<int>(whole->cameras.size()) == frames) return whole;
  WindowTruth truth = *whole;
  truth.cameras.resize(frames);
  if (!truth.uncertainties.empty()) truth.uncertainties.resize(frames);
  return std::make_shared<const WindowTruth>(std::move(truth));
}

/// A method that needs no plane gets its start from the tracks on it even where it then uses all.
RansacOptions ransac_options(const Settings& settings) {
  RansacOptions options;
  options.enabled = uses_ransac(settings) || !find_method(settings.method).needs_plane;
  options.threshold_px = settings.ransac_threshold_px;
  options.seed = settings.seed;
  return options;
}

void check_window(const Recording& recording, const Settings& settings) {
  const int count = recording.frame_count();
  if (settings.frames < 2) {
    throw InputError(fmt::format("--frames: {}, expected at least 2", settings.frames));
  }
  if (settings.start < 0 || settings.start >= count) {
    throw InputError(
        fmt::format("--start: frame {} is not in the recording, which has frames 0 to {}",
                    settings.start,
                    count - 1));
  }
  if (settings.start + settings.frames > count) {
    throw InputError(
        fmt::format("--frames: {} frames from frame {} on do not fit, the recording has {} frames",
                    settings.frames,
                    settings.start,
                    count));
  }
}

void check_excluded(const Tracks& tracks, const Settings& settings) {
  for (const std::int64_t id : settings.exclude) {
    if (std::ranges::find(tracks.ids, id) != tracks.ids.end()) continue;
    throw InputError(
        tracks.ids.empty()
            ? fmt::format("--exclude: track {} is not in the window, which has no tracks", id)
            : fmt::format("--exclude: track {} is not in the window, which has tracks {} to {}",
                          id,
                          std::ranges::min(tracks.ids),
                          std::ranges::max(tracks.ids)));
  }
}

std::vector<Verdict> verdicts_of(const std::vector<GrowthStep>& steps) {
  std::vector<Verdict> verdicts;
  verdicts.reserve(steps.size());
  for (const GrowthStep& step : steps) verdicts.push_back(step.verdict);
  return verdicts;
}

/// The plane z = 0 of a board.
const Plane kBoardPlane{-Eigen::Vector3d::UnitZ(), 0};

/// The board's plane in the truth's world, as the reference picture shows it.
std::optional<Plane> plane_of_board(const Recording& recording,
                                    int frame,
                                    const std::optional<Pose>& T_truth_camera) {
  if (!recording.board || !recording.pictures || !T_truth_camera) return std::nullopt;
  const auto corners = find_board(recording.pictures->gray(frame), *recording.board);
  const auto found = board_pose(corners, *recording.board, recording.camera);
  if (!found) return std::nullopt;
  return plane_in_camera(kBoardPlane, found->pose * inverse(*T_truth_camera));
}

/// The board's corners in the reference picture, for the cube; those that are hidden from its pose.
std::vector<Eigen::Vector2d> corners_in(const Recording& recording, int frame) {
  if (!recording.board || !recording.pictures) return {};
  auto corners = find_board(recording.pictures->gray(frame), *recording.board);
  const auto hidden = [](const Eigen::Vector2d& corner) { return !corner.allFinite(); };
  if (std::ranges::none_of(corners, hidden)) return corners;
  const auto found = board_pose(corners, *recording.board, recording.camera);
  if (!found) return {};
  const auto whole = project_board(*recording.board, recording.camera, found->pose);
  std::ranges::transform(corners, whole, corners.begin(), [&](const auto& seen, const auto& put) {
    return hidden(seen) ? put : seen;
  });
  return corners;
}

/// Tells people of an optimization, not more often than they can read it.
Watch told_by(const Settings& settings, const std::stop_token& stop, const Progress& progress) {
  if (!progress) return {stop};
  constexpr double kPause_ms = 40;
  const std::string title = find_method(settings.method).title;
  return {stop, [=, last = Clock::now()](int iteration, double cost) mutable {
            if (milliseconds_since(last) < kPause_ms) return;
            last = Clock::now();
            progress(fmt::format("{}: iteration {}, cost {:.4g} px\u00b2", title, iteration, cost),
                     0,
                     0);
          }};
}

}  // namespace

std::string inliers_note(const Inspection& inspection) {
  if (inspection.window->inliers == Inliers::consistent) return "tracks, consistent";
  const Settings& settings = inspection.settings;
  const bool asked = uses_ransac(settings) && inliers_used(settings) == Inliers::consistent;
  return asked ? "tracks, per frame: too few are consistent" : "tracks";
}

struct Inspector::Stages {
  std::shared_ptr<const Recording> recording;
  std::array<Kept<Span, Tracked>, 2> longest_tracks;  // of the windows from one start, by tracking
  Kept<Span, std::shared_ptr<const WindowTruth>> longest_truth;
  Kept<TrackedSpan, std::shared_ptr<const Tracks>> tracks;
  Kept<Span, std::shared_ptr<const WindowTruth>> truth;
  Kept<int, std::vector<Eigen::Vector2d>> board_corners;  // in the reference picture
  Kept<Rejected, std::shared_ptr<const Window>> outliers;
  Kept<std::tuple<Rejected, RotationSource>, Rotations> rotations;
  Kept<std::tuple<Rejected, RotationSource>, std::vector<Verdict>> growth;

  bool update_tracks(const Settings& settings,
                     const std::stop_token& stop,
                     const Progress& progress);
  bool update_truth(const Settings& settings,
                    const std::stop_token& stop,
                    const Progress& progress);
  std::shared_ptr<const WindowTruth> compute_truth(int start,
                                                   int frames,
                                                   const std::stop_token& stop,
                                                   const Progress& progress) const;
  void initialize(const Settings& settings,
                  const std::stop_token& stop,
                  const Progress& progress,
                  Inspection& inspection);
  bool update_window(const Settings& settings, RotationSource source, const std::stop_token& stop);
};

bool Inspector::Stages::update_tracks(const Settings& settings,
                                      const std::stop_token& stop,
                                      const Progress& progress) {
  const Span span(settings.start, settings.frames);
  Kept<Span, Tracked>& kept = longest_tracks[static_cast<std::size_t>(settings.tracking)];
  const Span longest = covering(kept.key, span);
  const int frames = std::get<1>(longest);
  const bool done = kept.update(longest, [&]() {
    return recording->tracks.empty()
               ? followed_tracks(
                     *recording, settings.start, frames, settings.tracking, stop, progress)
               : std::optional(chosen_tracks(*recording, settings.start, frames));
  });
  return done && tracks.update({span, settings.tracking}, [&]() {
    return std::optional(beginning(kept.value.tracks, settings.frames));
  });
}

std::shared_ptr<const WindowTruth> Inspector::Stages::compute_truth(
    int start, int frames, const std::stop_token& stop, const Progress& progress) const {
  if (recording->truth) {
    const auto begin = recording->truth->poses.begin() + start;
    WindowTruth truth{recording->truth->source, {begin, begin + frames}, recording->plane};
    if (!truth.plane) truth.plane = plane_of_board(*recording, start, truth.cameras.front());
    return std::make_shared<const WindowTruth>(std::move(truth));
  }
  if (!recording->board || !recording->pictures) return nullptr;
  const auto told = [&](int done, int of) {
    if (progress) progress("finding the board", done, of);
  };
  GroundTruth found = board_truth(*recording, start, frames, stop, told);
  return std::make_shared<const WindowTruth>(WindowTruth{
      found.source, std::move(found.poses), kBoardPlane, std::move(found.uncertainties)});
}

bool Inspector::Stages::update_truth(const Settings& settings,
                                     const std::stop_token& stop,
                                     const Progress& progress) {
  const Span span(settings.start, settings.frames);
  const Span longest = covering(longest_truth.key, span);
  const int frames = std::get<1>(longest);
  const bool done = longest_truth.update(longest, [&]() {
    auto computed = compute_truth(settings.start, frames, stop, progress);
    return stop.stop_requested() ? std::nullopt : std::optional(std::move(computed));
  });
  if (!done) return false;
  truth.update(span,
               [&]() { return std::optional(beginning(longest_truth.value, settings.frames)); });
  return board_corners.update(
      settings.start, [&]() { return std::optional(corners_in(*recording, settings.start)); });
}

bool Inspector::Stages::update_window(const Settings& settings,
                                      RotationSource source,
                                      const std::stop_token& stop) {
  check_excluded(*tracks.value, settings);
  const TrackedSpan span(Span(settings.start, settings.frames), settings.tracking);
  const RansacOptions ransac = ransac_options(settings);
  const Inliers inliers = inliers_used(settings);
  const Rejected rejected(span, settings.exclude, ransac, inliers);
  outliers.update(rejected, [&]() {
    return std::optional(
        std::make_shared<const Window>(make_window(without(*tracks.value, settings.exclude),
                                                   recording->camera,
                                                   recording->timestamps_ns,
                                                   ransac,
                                                   inliers)));
  });
  return rotations.update({rejected, source}, [&]() -> std::optional<Rotations> {
    Rotations computed =
        window_rotations(*recording, *outliers.value, truth.value.get(), source, stop);
    return stop.stop_requested() ? std::nullopt : std::optional(std::move(computed));
  });
}

void Inspector::Stages::initialize(const Settings& settings,
                                   const std::stop_token& stop,
                                   const Progress& progress,
                                   Inspection& inspection) {
  Window window = *outliers.value;
  window.all_tracks = !uses_ransac(settings);
  window.rotations = rotations.value.model;
  window.gyro = rotations.value.gyro;
  if (window.gyro) inspection.gyroscope_bias_rad_s = window.gyro->bias_rad_s;
  if (!rotations.value.R_wc.empty()) window.R_wc = rotations.value.R_wc;
  const auto begin = Clock::now();
  Initialization initialization =
      rotations.value.R_wc.empty()
          ? failed(rotations.value.reason)
          : find_method(settings.method)
                .initialize(window, settings.initializer, told_by(settings, stop, progress));
  Timing& t = inspection.timing;
  t.track = longest_tracks[static_cast<std::size_t>(settings.tracking)]
                .value.milliseconds[settings.frames - 1];
  t.ransac = outliers.milliseconds;
  t.rotations = rotations.milliseconds;
  t.initialize = milliseconds_since(begin);
  t.optimize = initialization.solver.milliseconds;
  t.total = t.track + t.ransac + t.rotations + t.initialize;
  if (!rotations.value.R_wc.empty()) {
    growth.update(*rotations.key, [&]() { return std::optional(verdicts_of(grow(window, stop))); });
    inspection.growth = growth.value;
    inspection.motion = frame_motion(window);
    initialization = assessed(find_method(settings.method), window, std::move(initialization));
    if (!initialization.verdict && static_cast<int>(growth.value.size()) == settings.frames - 1)
      initialization.verdict = growth.value.back();
  }
  inspection.tracks = tracks.value;
  inspection.truth = truth.value;
  inspection.window = std::make_shared<const Window>(std::move(window));
  inspection.initialization = std::make_shared<const Initialization>(std::move(initialization));
}

Inspector::Inspector(std::shared_ptr<const Recording> recording)
    : stages_(std::make_unique<Stages>()) {
  stages_->recording = std::move(recording);
}

Inspector::~Inspector() = default;

std::shared_ptr<const Inspection> Inspector::inspect(const Settings& settings,
                                                     const std::stop_token& stop,
                                                     const Progress& progress) {
  Stages& stages = *stages_;
  check_window(*stages.recording, settings);
  find_method(settings.method);  // throws before any work is done
  Inspection inspection;
  inspection.recording = stages.recording;
  inspection.settings = settings;
  inspection.rotations_used = rotation_source_used(*stages.recording, settings.rotations);
  const bool prepared = stages.update_tracks(settings, stop, progress) &&
                        stages.update_truth(settings, stop, progress) &&
                        stages.update_window(settings, inspection.rotations_used, stop);
  if (!prepared) return nullptr;
  if (progress) progress("initializing", 0, 0);
  stages.initialize(settings, stop, progress, inspection);
  if (stop.stop_requested()) return nullptr;
  if (inspection.initialization->ok) {
    if (inspection.truth) {
      inspection.evaluation = evaluate(
          *inspection.initialization, *inspection.window, *inspection.truth, settings.seed);
    }
    place_cubes(inspection, stages.board_corners.value);
  }
  return std::make_shared<const Inspection>(std::move(inspection));
}

}  // namespace gpo
