// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initialize.h"

#include "engine/base/error.h"
#include "engine/pipeline/method_defaults.h"
#include "engine/pipeline/pipeline.h"
#include "engine/window/tracks.h"

#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

void check(const Camera& camera,
           std::span<const Frame> frames,
           const Gyroscope* gyroscope,
           const InitializeOptions& options) {
  check_camera(camera);
  check_options(options);
  if (frames.size() < 2)
    throw InputError(fmt::format("a window of {} frames, expected at least 2", frames.size()));
  for (std::size_t i = 0; i < frames.size(); ++i)
    check_frame(frames[i], static_cast<int>(i), i > 0 ? &frames[i - 1] : nullptr);
  if (gyroscope != nullptr) check_gyroscope(*gyroscope);
}

Tracks tracks_of(std::span<const Frame> frames) {
  std::vector<TrackObservation> observations;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (std::size_t k = 0; k < frames[i].ids.size(); ++k)
      observations.push_back(
          {static_cast<int>(i), frames[i].ids[k], frames[i].raw_px.col(static_cast<int>(k))});
  }
  return select_tracks(observations, 0, static_cast<int>(frames.size()));
}

/// Returns the frames' own rotations, relative to the first one; empty if they have none.
std::vector<Eigen::Matrix3d> given_rotations(std::span<const Frame> frames) {
  std::vector<Eigen::Matrix3d> R_wc;
  for (const Frame& frame : frames)
    if (frame.R_wc) R_wc.emplace_back(frames[0].R_wc->transpose() * *frame.R_wc);
  return R_wc;
}

RotationSource requested_source(const InitializeOptions& options, bool given, bool has_gyroscope) {
  using enum RotationSource;
  if (given && (options.rotations == automatic || options.rotations == truth)) return truth;
  const char* lacks = options.rotations == truth                             ? "rotations"
                      : needs_gyroscope(options.rotations) && !has_gyroscope ? "gyroscope"
                                                                             : nullptr;
  if (lacks == nullptr) return options.rotations;
  throw SettingError("rotations",
                     fmt::format("{}: no {} given", to_string(options.rotations), lacks));
}

/// Completes names for messages; without a file, lines count samples.
Gyroscope with_names(Gyroscope gyroscope) {
  if (gyroscope.file.empty()) gyroscope.file = "gyroscope";
  if (gyroscope.lines.size() != gyroscope.timestamps_ns.size()) {
    gyroscope.lines.resize(gyroscope.timestamps_ns.size());
    std::iota(gyroscope.lines.begin(), gyroscope.lines.end(), 1);
  }
  return gyroscope;
}

/// Returns the camera's pose on the IMU; nullopt if its position is unknown.
std::optional<Pose> body_camera_of(const Gyroscope* gyroscope, const InitializeOptions& options) {
  if (gyroscope == nullptr || !options.p_gyro_camera_m) return std::nullopt;
  return Pose{gyroscope->R_gyro_camera, *options.p_gyro_camera_m};
}

}  // namespace

bool WindowResult::is_metric() const { return inertial && inertial->ok && inertial->scale_known; }

bool WindowResult::is_ready() const {
  return initialization.ok && initialization.verdict &&
         initialization.verdict->readiness == Readiness::ready;
}

WindowResult initialize(const Camera& camera,
                        std::span<const Frame> frames,
                        const Gyroscope* gyroscope,
                        const InitializeOptions& options,
                        const std::stop_token& stop) {
  check(camera, frames, gyroscope, options);
  const auto R_wc = given_rotations(frames);
  const RotationSource requested = requested_source(options, !R_wc.empty(), gyroscope != nullptr);
  std::optional<Gyroscope> named;
  if (gyroscope != nullptr) named = with_names(*gyroscope);
  const Gyroscope* gyro = named ? &*named : nullptr;

  std::vector<std::int64_t> timestamps_ns;
  for (const Frame& frame : frames) timestamps_ns.push_back(frame.timestamp_ns);
  Tracks tracks = tracks_of(frames);
  Window window = window_of(tracks, camera, timestamps_ns, options);
  const ChosenRotations chosen =
      chosen_rotations(window, {gyro, R_wc, ransac_options(options)}, requested, stop);

  WindowResult result;
  result.ids = std::move(tracks.ids);
  result.rotations = chosen.source;
  result.rotations_note = chosen.note;
  result.window = with_rotations(std::move(window), chosen.rotations, options);
  const Sources sources{&camera, gyro, body_camera_of(gyro, options)};
  Initialization found = run_method(result.window, chosen.rotations, sources, options, stop);
  std::vector<Verdict> growth;
  const bool needs_growth = !found.ok && !found.verdict && !chosen.rotations.R_wc.empty();
  if (needs_growth) growth = growing_verdicts(result.window, stop);
  Finished end = finished(result.window, sources, options, growth, std::move(found));
  result.initialization = std::move(end.initialization);
  result.inertial = std::move(end.inertial);
  return result;
}

}  // namespace gpo
