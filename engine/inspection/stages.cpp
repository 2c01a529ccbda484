// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/stages.h"

#include "engine/base/error.h"
#include "engine/frontend/make_window.h"
#include "engine/inertial/scale_since.h"
#include "engine/inertial/uncertain_poses.h"
#include "engine/initialize/gravity.h"
#include "engine/initialize/steps.h"
#include "engine/initializers/methods.h"
#include "engine/inspection/settings/setting_values.h"
#include "engine/inspection/window/window_rotations.h"
#include "engine/inspection/window/window_truth.h"

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
  acting.ransac = ransac_options(options_of(settings)).enabled;
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
  const std::string title = find_method(settings.method).title;
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
  const auto& files = recording.picture_files;
  if (std::ssize(files) == recording.frame_count()) {
    sources.pictures.assign(files.begin() + window.start,
                            files.begin() + window.start + window.frame_count());
  } else if (files.size() == 1) {
    sources.pictures = files;
  }
  return sources;
}

Initialization initialized(const Recording& recording,
                           const Window& window,
                           const Settings& settings,
                           const Watch& watch) {
  const Method& method = find_method(settings.method);
  return method.initialize_from
             ? method.initialize_from(window, sources_of(recording, window), watch)
             : method.initialize(window, settings.initializer, watch);
}

/// Gravity and meters; nothing where the recording has no accelerometer.
void align(const Window& window,
           Gravity when,
           Initialization& initialization,
           Inspection& inspection) {
  const auto& gyroscope = inspection.recording->gyroscope;
  const auto& T_body_camera = inspection.recording->T_body_camera;
  if (!gyroscope || gyroscope->accelerations_m_s2.empty()) return;
  const UncertainPoses poses = uncertain_poses(window, initialization);
  inspection.inertial =
      find_gravity(window, poses, *gyroscope, T_body_camera, when, initialization);
  if (!inspection.inertial->ok || !inspection.inertial->scale_known) return;
  const auto count = poses_that_tell_scale(poses, *gyroscope, T_body_camera);
  if (!count) return;
  const auto at = std::ranges::find(window.timestamps_ns, poses.times_ns[*count - 1]);
  inspection.scale_known_at = static_cast<int>(at - window.timestamps_ns.begin());
}

}  // namespace

bool Stages::update_tracks(const Settings& settings,
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
  const RansacOptions ransac = ransac_options(options_of(settings));
  const Inliers inliers = inliers_used(settings);
  outliers.update(rejecting(SettingStage::inliers, settings), [&]() {
    return std::optional(
        std::make_shared<const Window>(make_window(without(*tracks.value, settings.exclude),
                                                   recording->camera,
                                                   recording->timestamps_ns,
                                                   ransac,
                                                   inliers,
                                                   settings.plane - 1)));
  });
  const Settings turning = rejecting(SettingStage::rotations, settings);
  return rotations.update(turning, [&]() -> std::optional<ChosenRotations> {
    ChosenRotations chosen = window_rotations(*recording,
                                              *outliers.value,
                                              truth.value.get(),
                                              settings.rotations,
                                              ransac_options(options_of(turning)),
                                              stop);
    return chosen.rotations.stopped ? std::nullopt : std::optional(std::move(chosen));
  });
}

void Stages::initialize(const Settings& settings,
                        const std::stop_token& stop,
                        const Progress& progress,
                        Inspection& inspection) {
  const Rotations& given = rotations.value.rotations;
  inspection.rotations_used = rotations.value.source;
  inspection.rotations_note = rotations.value.note;
  Window window = with_rotations(*outliers.value, given, !uses_ransac(settings));
  if (window.gyro) inspection.gyroscope_bias_rad_s = window.gyro->bias_rad_s;
  const auto begin = std::chrono::steady_clock::now();
  Initialization initialization =
      given.R_wc.empty()
          ? failed(given.reason)
          : initialized(*recording, window, settings, told_by(settings, stop, progress));
  Timing& t = inspection.timing;
  t.track = longest_tracks[static_cast<std::size_t>(settings.tracking)]
                .value.milliseconds[settings.frames - 1];
  t.ransac = outliers.milliseconds;
  t.rotations = rotations.milliseconds;
  t.initialize = milliseconds_since(begin);
  t.optimize = initialization.solver.milliseconds;
  t.total = t.track + t.ransac + t.rotations + t.initialize;
  if (!given.R_wc.empty()) {
    // What was stopped is short, and no result.
    const bool grown = growth.update(*rotations.key, [&]() {
      auto verdicts = growing_verdicts(window, stop);
      return stop.stop_requested() ? std::nullopt : std::optional(std::move(verdicts));
    });
    if (!grown) return;
    inspection.growth = growth.value;
    inspection.motion = frame_motion(window);
    initialization = assessed(find_method(settings.method), window, std::move(initialization));
  }
  if (initialization.ok && settings.gravity != Gravity::off)
    align(window, gravity_used(settings), initialization, inspection);
  complete_verdict(window, inspection.growth, initialization);
  if (recording->camera_source == CameraSource::guess) {
    std::ranges::for_each(inspection.growth, demote);
    if (initialization.verdict) demote(*initialization.verdict);
  }
  inspection.tracks = tracks.value;
  inspection.truth = truth.value;
  inspection.window = std::make_shared<const Window>(std::move(window));
  inspection.initialization = std::make_shared<const Initialization>(std::move(initialization));
}

}  // namespace gpo
