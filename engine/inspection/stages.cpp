// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/stages.h"

#include "engine/base/error.h"
#include "engine/inertial/inertial_alignment.h"
#include "engine/inspection/settings/setting_values.h"
#include "engine/inspection/window/window_rotations.h"
#include "engine/inspection/window/window_truth.h"
#include "engine/pipeline/method_defaults.h"
#include "engine/pipeline/pipeline.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

/// What is kept where it begins at the same frame and is long enough, else what is wanted.
Span covering(const std::optional<Span>& kept, const Span& wanted) {
  const auto [start, frames] = wanted;
  const bool covers = kept && std::get<0>(*kept) == start && std::get<1>(*kept) >= frames;
  return covers ? *kept : wanted;
}

/// The settings that act until the stage; RANSAC as it is used here, alike for methods that take
/// all tracks in the end and those that never do.
Settings rejecting(SettingStage stage, const Settings& settings) {
  Settings acting = acting_until(stage, settings);
  acting.options.ransac = ransac_options(settings.options).enabled;
  return acting;
}

void check_excluded(const Tracks& tracks, const Settings& settings) {
  for (const std::int64_t id : settings.exclude) {
    if (std::ranges::find(tracks.ids, id) != tracks.ids.end()) continue;
    throw SettingError("exclude",
                       tracks.ids.empty()
                           ? fmt::format("track {} is not in the window, which has no tracks", id)
                           : fmt::format("track {} is not in the window, which has tracks {} to {}",
                                         id,
                                         std::ranges::min(tracks.ids),
                                         std::ranges::max(tracks.ids)));
  }
}

/// Tells people of an optimization, not more often than they can read it.
Watch told_by(const Settings& settings, const std::stop_token& stop, const Progress& progress) {
  if (!progress) return {stop};
  constexpr double kPause_ms = 40;
  const std::string title = settings.options.method.row().title;
  return {stop, [=, last = std::chrono::steady_clock::now()](int iteration, double cost) mutable {
            if (milliseconds_since(last) < kPause_ms) return;
            last = std::chrono::steady_clock::now();
            progress(fmt::format("{}: iteration {}, cost {:.4g} px\u00b2", title, iteration, cost),
                     0,
                     0);
          }};
}

/// What the window was made of.
Sources sources_of(const Recording& recording, const Window& window) {
  Sources sources;
  sources.camera = &recording.camera;
  sources.gyroscope = recording.gyroscope ? &*recording.gyroscope : nullptr;
  sources.T_body_camera = recording.T_body_camera;
  const auto& files = recording.image_files;
  if (std::ssize(files) == recording.frame_count()) {
    sources.images.assign(files.begin() + window.start,
                            files.begin() + window.start + window.frame_count());
  } else if (files.size() == 1) {
    sources.images = files;
  }
  return sources;
}

/// The options with what the recording determines.
InitializeOptions options_for(const Recording& recording, const Settings& settings) {
  InitializeOptions options = settings.options;
  if (recording.camera_source == CameraSource::guess) options.camera_is_guess = true;
  return options;
}

/// Frame of the window up to which it takes to know the scale; nullopt if it is not known.
std::optional<int> metric_scale_from(const Window& window,
                                  const Sources& sources,
                                  const Finished& end) {
  if (!end.inertial || !end.inertial->ok || !end.inertial->scale_known) return std::nullopt;
  const auto count =
      poses_that_determine_scale(end.poses, *sources.gyroscope, sources.T_body_camera);
  if (!count) return std::nullopt;
  const auto at = std::ranges::find(window.timestamps_ns, end.poses.times_ns[*count - 1]);
  return static_cast<int>(at - window.timestamps_ns.begin());
}

Timing timing_of(const Stages& stages, const Settings& settings, double initialize_ms) {
  const Cached<Span, Tracked>& followed =
      stages.longest_tracks[static_cast<std::size_t>(settings.tracking)];
  Timing t;
  t.track = followed.value.milliseconds[settings.frames - 1];
  t.ransac = stages.outliers.milliseconds;
  t.rotations = stages.rotations.milliseconds;
  t.initialize = initialize_ms;
  t.total = t.track + t.ransac + t.rotations + t.initialize;
  return t;
}

}  // namespace

bool Stages::update_tracks(const Settings& settings,
                           const std::stop_token& stop,
                           const Progress& progress) {
  const Span span(settings.start, settings.frames);
  Cached<Span, Tracked>& kept = longest_tracks[static_cast<std::size_t>(settings.tracking)];
  const Span longest = covering(kept.key, span);
  const int frames = std::get<1>(longest);
  const bool done = kept.update(longest, [&]() {
    return recording->tracks.empty()
               ? followed_tracks(
                     *recording, settings.start, frames, settings.tracking, stop, progress)
               : std::optional(chosen_tracks(*recording, settings.start, frames));
  });
  return done && tracks.update(acting_until(SettingStage::tracks, settings), [&]() {
    return std::optional(beginning(kept.value.tracks, settings.frames));
  });
}

bool Stages::update_truth(const Settings& settings,
                          const std::stop_token& stop,
                          const Progress& progress) {
  const Span span(settings.start, settings.frames);
  const Span longest = covering(longest_truth.key, span);
  const int frames = std::get<1>(longest);
  const bool done = longest_truth.update(longest, [&]() {
    auto computed = window_truth(*recording, settings.start, frames, stop, progress);
    return stop.stop_requested() ? std::nullopt : std::optional(std::move(computed));
  });
  if (!done) return false;
  truth.update(span,
               [&]() { return std::optional(beginning(longest_truth.value, settings.frames)); });
  return board_corners.update(
      settings.start, [&]() { return std::optional(corners_in(*recording, settings.start)); });
}

bool Stages::update_window(const Settings& settings, const std::stop_token& stop) {
  check_excluded(*tracks.value, settings);
  outliers.update(rejecting(SettingStage::inliers, settings), [&]() {
    return std::optional(
        std::make_shared<const Window>(window_of(without(*tracks.value, settings.exclude),
                                                 recording->camera,
                                                 recording->timestamps_ns,
                                                 settings.options)));
  });
  const Settings turning = rejecting(SettingStage::rotations, settings);
  return rotations.update(turning, [&]() -> std::optional<ChosenRotations> {
    ChosenRotations chosen = window_rotations(*recording,
                                              *outliers.value,
                                              truth.value.get(),
                                              settings.options.rotations,
                                              ransac_options(turning.options),
                                              stop);
    return chosen.rotations.stopped ? std::nullopt : std::optional(std::move(chosen));
  });
}

void Stages::initialize(const Settings& settings,
                        const std::stop_token& stop,
                        const Progress& progress,
                        Inspection& inspection) {
  const Rotations& given = rotations.value.rotations;
  const InitializeOptions options = options_for(*recording, settings);
  Window window = with_rotations(*outliers.value, given, options);
  const Sources sources = sources_of(*recording, window);
  const auto begin = std::chrono::steady_clock::now();
  Initialization found =
      run_method(window, given, sources, options, told_by(settings, stop, progress));
  inspection.timing = timing_of(*this, settings, milliseconds_since(begin));
  inspection.timing.optimize = found.solver.milliseconds;
  if (!given.R_wc.empty()) {
    // What was stopped is short, and no result.
    const bool grown = growth.update(*rotations.key, [&]() {
      auto verdicts = growing_verdicts(window, stop);
      return stop.stop_requested() ? std::nullopt : std::optional(std::move(verdicts));
    });
    if (!grown) return;
    inspection.growth = growth.value;
    inspection.motion = frame_motion(window);
    if (options.camera_is_guess) std::ranges::for_each(inspection.growth, demote);
  }
  Finished end = finished(window, sources, options, inspection.growth, std::move(found));
  inspection.metric_scale_from = metric_scale_from(window, sources, end);
  inspection.inertial = std::move(end.inertial);
  if (window.gyro) inspection.gyroscope_bias_rad_s = window.gyro->bias_rad_s;
  inspection.rotations_used = rotations.value.source;
  inspection.rotations_note = rotations.value.note;
  inspection.tracks = tracks.value;
  inspection.truth = truth.value;
  inspection.window = std::make_shared<const Window>(std::move(window));
  inspection.initialization = std::make_shared<const Initialization>(std::move(end.initialization));
}

}  // namespace gpo
