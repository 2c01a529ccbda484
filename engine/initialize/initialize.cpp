// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initialize.h"

#include "engine/base/error.h"
#include "engine/frontend/make_window.h"
#include "engine/inertial/uncertain_poses.h"
#include "engine/initialize/chosen_rotations.h"
#include "engine/initialize/gravity.h"
#include "engine/initialize/input_checks.h"
#include "engine/initialize/steps.h"
#include "engine/initializers/methods.h"
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

/// The frames' own rotations, relative to the first one; empty where they have none.
std::vector<Eigen::Matrix3d> given_rotations(std::span<const Frame> frames) {
  std::vector<Eigen::Matrix3d> R_wc;
  for (const Frame& frame : frames)
    if (frame.R_wc) R_wc.emplace_back(frames[0].R_wc->transpose() * *frame.R_wc);
  return R_wc;
}

RotationSource asked_for(const InitializeOptions& options, bool given, bool has_gyroscope) {
  using enum RotationSource;
  if (given && (options.rotations == automatic || options.rotations == truth)) return truth;
  const char* lacks = options.rotations == truth                             ? "rotations"
                      : needs_gyroscope(options.rotations) && !has_gyroscope ? "gyroscope"
                                                                             : nullptr;
  if (lacks == nullptr) return options.rotations;
  throw SettingError("rotations",
                     fmt::format("{}: no {} given", to_string(options.rotations), lacks));
}

/// With what messages name: lines of a file that there is none of are samples.
Gyroscope with_names(Gyroscope gyroscope) {
  if (gyroscope.file.empty()) gyroscope.file = "gyroscope";
  if (gyroscope.lines.size() != gyroscope.timestamps_ns.size()) {
    gyroscope.lines.resize(gyroscope.timestamps_ns.size());
    std::iota(gyroscope.lines.begin(), gyroscope.lines.end(), 1);
  }
  return gyroscope;
}

Initialization solved(const Window& window,
                      const InitializeOptions& options,
                      const Sources& sources,
                      const std::stop_token& stop) {
  const Method& method = find_method(options.method);
  Initialization result = method.initialize_from
                              ? method.initialize_from(window, sources, stop)
                              : method.initialize(window, options.initializer, stop);
  return assessed(method, window, std::move(result));
}

/// Nothing without accelerations.
std::optional<InertialAlignment> aligned(const Window& window,
                                         const Gyroscope* gyroscope,
                                         const InitializeOptions& options,
                                         Initialization& initialization) {
  if (gyroscope == nullptr || gyroscope->accelerations_m_s2.empty()) return std::nullopt;
  std::optional<Pose> T_gyro_camera;
  if (options.p_gyro_camera_m)
    T_gyro_camera = Pose{gyroscope->R_gyro_camera, *options.p_gyro_camera_m};
  return find_gravity(window,
                      uncertain_poses(window, initialization),
                      *gyroscope,
                      T_gyro_camera,
                      gravity_used(options),
                      initialization);
}

}  // namespace

bool Initialized::is_metric() const { return inertial && inertial->ok && inertial->scale_known; }

bool Initialized::is_ready() const {
  return initialization.ok && initialization.verdict &&
         initialization.verdict->readiness == Readiness::ready;
}

Initialized initialize(const Camera& camera,
                       std::span<const Frame> frames,
                       const Gyroscope* gyroscope,
                       const InitializeOptions& options,
                       const std::stop_token& stop) {
  check(camera, frames, gyroscope, options);
  const auto R_wc = given_rotations(frames);
  const RotationSource asked = asked_for(options, !R_wc.empty(), gyroscope != nullptr);
  std::optional<Gyroscope> named;
  if (gyroscope != nullptr) named = with_names(*gyroscope);
  const Gyroscope* gyro = named ? &*named : nullptr;

  std::vector<std::int64_t> timestamps_ns;
  for (const Frame& frame : frames) timestamps_ns.push_back(frame.timestamp_ns);
  Tracks tracks = tracks_of(frames);
  const RansacOptions ransac = ransac_options(options);
  Window window =
      make_window(tracks, camera, timestamps_ns, ransac, inliers_used(options), options.plane - 1);
  const ChosenRotations chosen = chosen_rotations(window, gyro, R_wc, asked, ransac, stop);

  Initialized result;
  result.ids = std::move(tracks.ids);
  result.rotations = chosen.source;
  result.rotations_note = chosen.note;
  result.window = with_rotations(std::move(window), chosen.rotations, !uses_ransac(options));
  Initialization& initialization = result.initialization;
  std::vector<Verdict> growth;
  if (chosen.rotations.R_wc.empty()) {
    initialization = failed(chosen.rotations.reason);
    initialization.stopped = chosen.rotations.stopped;
  } else {
    initialization = solved(result.window, options, {&camera, gyro}, stop);
    if (!initialization.verdict) growth = growing_verdicts(result.window, stop);
  }
  if (initialization.ok && options.gravity != Gravity::off)
    result.inertial = aligned(result.window, gyro, options, initialization);
  complete_verdict(result.window, growth, initialization);
  if (options.camera_is_guess && initialization.verdict) demote(*initialization.verdict);
  return result;
}

}  // namespace gpo
